// Options for the alignment of the estimate: --align MODE, and evo's flags.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "eval/metrics/trajectory_error/alignment.hpp"

namespace CLI {
class App;
}

namespace fusebench::cli::trajectories {

struct AlignmentOptions {
  std::string mode;
  bool evo_align = false;
  bool evo_scale = false;
  bool evo_origin = false;
  std::size_t n_to_align = 0;

  [[nodiscard]] bool asked() const { return !mode.empty() || evo_align || evo_scale || evo_origin; }
};

inline constexpr std::array<std::pair<const char*, trajectory_error::AlignmentMode>, 6> kAlignments{
    {{"none", trajectory_error::AlignmentMode::none},
     {"se3", trajectory_error::AlignmentMode::se3},
     {"sim3", trajectory_error::AlignmentMode::sim3},
     {"scale", trajectory_error::AlignmentMode::scale},
     {"yaw", trajectory_error::AlignmentMode::yaw},
     {"origin", trajectory_error::AlignmentMode::origin}}};

/// The names, for the parser's check.
template <typename T, std::size_t N>
std::vector<std::string> names_of(const std::array<std::pair<const char*, T>, N>& names) {
  std::vector<std::string> list;
  for (const auto& [name, value] : names) list.emplace_back(name);
  return list;
}

/// The value of a name that the parser has accepted.
template <typename T, std::size_t N>
T named(const std::array<std::pair<const char*, T>, N>& names, const std::string& name) {
  for (const auto& [known, value] : names) {
    if (name == known) return value;
  }
  return names.front().second;  // the parser accepts no other name
}

void add_alignment_options(CLI::App& verb, AlignmentOptions& options);

/// A protocol's alignment with the changes by the options. Error usage for options that exclude each other.
[[nodiscard]] Result<trajectory_error::AlignmentRequest> aligned_by(const AlignmentOptions& options,
                                                                    trajectory_error::AlignmentRequest usual);

}  // namespace fusebench::cli::trajectories
