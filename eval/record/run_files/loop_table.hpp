// loops.csv and places.csv, as core/estimator/places/loops/loop_tables.hpp writes them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::run_files {

/// What became of a pair of places that was checked.
enum class CandidateFate {
  accepted_by_features,
  accepted_by_depth,    ///< by depth alone
  accepted_by_tracker,  ///< a lost tracker found itself there; images and depth of the pair do not verify it
  no_pose,              ///< neither features nor depth tell for certain how the two stand to each other
  depth_differs,        ///< there is a pose, by which the two do not see the same
  poses_differ,  ///< verified or found by the tracker, but that contradicts the path or the other loops
};

/// A candidate, as far as reports need it.
struct CandidateRow {
  std::int64_t query_ns = 0;
  std::int64_t place_ns = 0;  ///< of the older frame
  CandidateFate fate = CandidateFate::no_pose;

  [[nodiscard]] bool is_accepted() const {
    return fate == CandidateFate::accepted_by_features || fate == CandidateFate::accepted_by_depth ||
           fate == CandidateFate::accepted_by_tracker;
  }
};

/// A place, as far as reports need it.
struct PlaceRow {
  std::int64_t timestamp_ns = 0;
  double blur_px = 0;
  double candidates = 0;
  double accepted = 0;
};

/// In the order of the file. Errors: data_missing; data_corrupt (a column that is not there, a row of another
/// length, an unknown word, what is no number).
[[nodiscard]] Result<std::vector<CandidateRow>> read_candidate_table(const std::filesystem::path& file);
[[nodiscard]] Result<std::vector<PlaceRow>> read_place_table(const std::filesystem::path& file);

}  // namespace fusebench::run_files
