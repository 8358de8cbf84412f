#include "datasets/recording/exports/export_recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <limits>
#include <string>
#include <utility>

#include "core/base/nearest_name.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/recording/exports/export_formats.hpp"
#include "datasets/recording/exports/export_place.hpp"
#include "datasets/recording/reading/side_files.hpp"

namespace fusebench::exports {

namespace {

using PlaceKind = ExportPlace::Kind;
constexpr std::size_t kAnyNumber = std::numeric_limits<std::size_t>::max();

struct FormatRow {
  std::string_view name;
  PlaceKind kind;
  std::size_t most_frames;
  std::string_view limited_by;
  DepthStorage depth;
  bool writes_imu;
  Result<WrittenExport> (*write)(const recording::Recording& recording, const ExportPlace& place);
};

// In the order of ExportFormat.
constexpr std::array<FormatRow, 6> kFormats = {{
    {"tum", PlaceKind::folder, kAnyNumber, "", kTumDepth, true, write_tum},
    {"infinitam", PlaceKind::folder, kAnyNumber, "", kInfinitamDepth, false, write_infinitam},
    {"klg", PlaceKind::files, kKlgMostFrames, "ElasticFusion", kKlgDepth, false, write_klg},
    {"sens", PlaceKind::files, kSensMostFrames, "BundleFusion", kSensDepth, false, write_sens},
    {"open3d", PlaceKind::folder, kAnyNumber, "", kOpen3dDepth, false, write_open3d},
    {"euroc", PlaceKind::folder, kAnyNumber, "", kEurocDepth, true, write_euroc},
}};

const FormatRow& row_of(ExportFormat format) { return kFormats[static_cast<std::size_t>(format)]; }

Result<void> check_frames(const recording::Recording& recording, const FormatRow& row) {
  const std::size_t count = recording.frames.size();
  if (count == 0)
    return fail(ErrorCode::usage, fmt::format("'{}' has no frames to export", recording.name),
                "`fusebench inspect` lists its contents");
  if (count > row.most_frames)
    return fail(ErrorCode::usage,
                fmt::format("'{}' has {} frames (allowed in {}: 1 .. {}, which {} takes)", recording.name,
                            count, row.name, row.most_frames, row.limited_by),
                "export a part of it with --frames A:B");
  for (std::size_t k = 1; k < count; ++k) {
    if (recording.frames[k].timestamp_ns > recording.frames[k - 1].timestamp_ns) continue;
    return fail(ErrorCode::data_corrupt,
                fmt::format("'{}': frames {} and {} have stamps {} and {} (they must rise)", recording.name,
                            k - 1, k, trajectory::stamp_text(recording.frames[k - 1].timestamp_ns),
                            trajectory::stamp_text(recording.frames[k].timestamp_ns)),
                "`fusebench inspect` shows details; leave these frames out with --frames A:B");
  }
  return {};
}

/// The file by which simulated data keep that label when the export is opened as a recording.
Result<void> write_label(const recording::Recording& recording, PlaceKind kind, const ExportPlace& place) {
  if (!recording.simulated) return {};
  const std::string_view file = reading::kSimulationFile;
  return place.write({{kind == PlaceKind::folder ? std::string(file) : place.beside(file),
                       fmt::format("# exported from the simulated recording {}\n", recording.name)}});
}

}  // namespace

std::string_view to_string(ExportFormat format) { return row_of(format).name; }

std::vector<std::string_view> export_format_names() {
  std::vector<std::string_view> names;
  for (const FormatRow& row : kFormats) names.push_back(row.name);
  return names;
}

Result<ExportFormat> parse_export_format(std::string_view name) {
  for (std::size_t k = 0; k < kFormats.size(); ++k) {
    if (kFormats[k].name == name) return static_cast<ExportFormat>(k);
  }
  const std::vector<std::string_view> names = export_format_names();
  return fail(ErrorCode::configuration, fmt::format("format = {} (allowed {})", name, fmt::join(names, ", ")),
              did_you_mean(name, names));
}

Result<ExportSummary> export_recording(const recording::Recording& recording, ExportFormat format,
                                       const std::filesystem::path& out) {
  const FormatRow& row = row_of(format);
  if (const auto fits = check_frames(recording, row); !fits) return tl::unexpected(fits.error());
  auto place = ExportPlace::create(out, row.kind);
  if (!place) return tl::unexpected(place.error());
  auto written = row.write(recording, *place);
  if (!written) return tl::unexpected(written.error());
  if (!row.writes_imu && !recording.imu.empty()) written->notes.push_back("inertial samples are not written");
  if (const auto labelled = write_label(recording, row.kind, *place); !labelled)
    return tl::unexpected(labelled.error());
  if (const auto done = place->commit(); !done) return tl::unexpected(done.error());
  // Files are in the folder of the export, or beside its file.
  const std::filesystem::path folder = std::filesystem::is_directory(out) ? out : out.parent_path();
  const std::filesystem::path calibration =
      written->calibration.empty() ? std::filesystem::path() : folder / written->calibration;
  return ExportSummary{format,
                       out,
                       recording.frames.size(),
                       row.depth,
                       written->depth,
                       std::move(written->files),
                       std::move(written->notes),
                       calibration};
}

}  // namespace fusebench::exports
