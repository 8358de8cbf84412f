#include "eval/record/run_files/loop_table.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "eval/record/run_files/named_rows.hpp"

namespace fusebench::run_files {

namespace {

/// What a pair can be verified by, and what it is then, if it is accepted.
constexpr std::array<std::pair<std::string_view, CandidateFate>, 3> kVerified = {
    {{"features", CandidateFate::accepted_by_features},
     {"depth", CandidateFate::accepted_by_depth},
     {"tracker", CandidateFate::accepted_by_tracker}}};

Result<double> needed_number(const NamedRow& cells, std::string_view name) {
  const auto number = cells.number(name);
  if (!number) return tl::unexpected(number.error());
  if (!*number) return fail(ErrorCode::data_corrupt, fmt::format("{} is empty", name));
  return **number;
}

/// A pair without a pose has zeros and the identity.
Result<bool> has_pose(const NamedRow& cells) {
  for (const char* const name : {"tx_m", "ty_m", "tz_m", "qx", "qy", "qz"}) {
    const auto value = needed_number(cells, name);
    if (!value) return tl::unexpected(value.error());
    if (*value != 0) return true;
  }
  return false;
}

Result<CandidateFate> fate_of(const NamedRow& cells) {
  const auto verified_by = cells.text("verified_by");
  if (!verified_by) return tl::unexpected(verified_by.error());
  const auto decision = cells.text("decision");
  if (!decision) return tl::unexpected(decision.error());
  const bool accepted = *decision == "accepted";
  if (!accepted && *decision != "refused")
    return fail(ErrorCode::data_corrupt, fmt::format("decision '{}' (accepted, refused)", *decision));
  for (const auto& [word, fate] : kVerified) {
    if (*verified_by == word) return accepted ? fate : CandidateFate::poses_differ;
  }
  if (*verified_by != "nothing" || accepted)
    return fail(ErrorCode::data_corrupt, fmt::format("{}, verified by '{}'", *decision, *verified_by));
  return has_pose(cells).transform(
      [](bool pose) { return pose ? CandidateFate::depth_differs : CandidateFate::no_pose; });
}

Result<CandidateRow> candidate_of(const NamedRow& cells) {
  const auto query_ns = cells.time_ns("query_s");
  if (!query_ns) return tl::unexpected(query_ns.error());
  const auto place_ns = cells.time_ns("place_s");
  if (!place_ns) return tl::unexpected(place_ns.error());
  return fate_of(cells).map([&](CandidateFate fate) { return CandidateRow{*query_ns, *place_ns, fate}; });
}

Result<PlaceRow> place_of(const NamedRow& cells) {
  PlaceRow row;
  const auto stamp = cells.time_ns("timestamp_s");
  if (!stamp) return tl::unexpected(stamp.error());
  row.timestamp_ns = *stamp;
  const std::array<std::pair<const char*, double*>, 3> numbers = {
      {{"blur_px", &row.blur_px}, {"candidates", &row.candidates}, {"accepted", &row.accepted}}};
  for (const auto& [name, value] : numbers) {
    const auto number = needed_number(cells, name);
    if (!number) return tl::unexpected(number.error());
    *value = *number;
  }
  return row;
}

}  // namespace

Result<std::vector<CandidateRow>> read_candidate_table(const std::filesystem::path& file) {
  return read_named_rows(file, candidate_of);
}

Result<std::vector<PlaceRow>> read_place_table(const std::filesystem::path& file) {
  return read_named_rows(file, place_of);
}

}  // namespace fusebench::run_files
