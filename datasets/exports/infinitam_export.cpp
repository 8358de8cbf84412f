#include "datasets/exports/infinitam_export.hpp"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "datasets/exports/pnm_file.hpp"
#include "datasets/exports/quantised_frames.hpp"
#include "datasets/exports/sensor_tables.hpp"

namespace fusebench::exports {

namespace {

std::string calibration_text(const PinholeCamera& camera) {
  const std::string one = fmt::format("{} {}\n{} {}\n{} {}\n\n", camera.width_px, camera.height_px,
                                      camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px);
  return one + one + "1 0 0 0\n0 1 0 0\n0 0 1 0\n\naffine 0.001 0\n";
}

tl::unexpected<Error> no_mask(std::string_view mask) {
  return fail(ErrorCode::usage, fmt::format("'{}' is no mask: it needs one %i, %d or %04i", mask),
              "e.g. color/%04i.ppm");
}

}  // namespace

Result<std::string> masked_name(std::string_view mask, std::size_t index) {
  constexpr int kMostDigits = 20;
  const std::size_t begin = mask.find('%');
  if (begin == std::string_view::npos) return no_mask(mask);
  const std::size_t end = mask.find_first_of("id", begin);
  if (end == std::string_view::npos || mask.find('%', begin + 1) != std::string_view::npos)
    return no_mask(mask);
  const std::string_view width = mask.substr(begin + 1, end - begin - 1);
  int digits = 0;
  if (!width.empty()) {
    const auto [stop, error] = std::from_chars(width.data(), width.data() + width.size(), digits);
    const bool whole = error == std::errc{} && stop == width.data() + width.size();
    if (!whole || width.front() != '0' || digits > kMostDigits) return no_mask(mask);
  }
  return fmt::format("{}{:0{}}{}", mask.substr(0, begin), index, digits, mask.substr(end + 1));
}

Result<WrittenExport> write_infinitam(const recording::Recording& recording, const ExportPlace& place) {
  for (const std::string_view folder : {"color", "depth"}) {
    if (const auto created = place.create_folder(folder); !created) return tl::unexpected(created.error());
  }
  const auto write = [&](const QuantisedFrame& frame) -> Result<void> {
    const auto color = masked_name(kInfinitamColorMask, frame.index);
    const auto depth = masked_name(kInfinitamDepthMask, frame.index);
    check(color && depth, "the masks are masks");
    if (auto written = place.write(*color, ppm_bytes(frame.color)); !written) return written;
    return place.write(*depth, pgm_bytes(frame.depth));
  };
  const auto counts = for_each_frame(recording, kInfinitamDepth, write);
  if (!counts) return tl::unexpected(counts.error());
  const auto calibrated = place.write("calib.txt", calibration_text(recording.rig.camera));
  if (!calibrated) return tl::unexpected(calibrated.error());
  const auto timed = place.write("frame_times.txt", frame_time_table(recording.frames));
  if (!timed) return tl::unexpected(timed.error());
  WrittenExport result{*counts, {"calib.txt", kInfinitamColorMask, kInfinitamDepthMask}, {}};
  result.calibration = "calib.txt";
  result.notes = {
      fmt::format("InfiniTAM: InfiniTAM_cli calib.txt {} {}", kInfinitamColorMask, kInfinitamDepthMask),
      "frames have numbers and no time: frame_times.txt has the stamp of each"};
  if (!recording.imu.empty()) result.notes.push_back("inertial samples are not written");
  return result;
}

Result<std::optional<InfinitamFrame>> read_infinitam_frame(const std::string& color_mask,
                                                           const std::string& depth_mask, std::size_t index) {
  const auto color_name = masked_name(color_mask, index);
  if (!color_name) return tl::unexpected(color_name.error());
  const auto depth_name = masked_name(depth_mask, index);
  if (!depth_name) return tl::unexpected(depth_name.error());
  std::error_code ignored;
  if (!std::filesystem::exists(*color_name, ignored) && !std::filesystem::exists(*depth_name, ignored))
    return std::nullopt;
  auto color = read_ppm(*color_name);
  if (!color) return tl::unexpected(color.error());
  auto depth = read_pgm(*depth_name);
  if (!depth) return tl::unexpected(depth.error());
  return InfinitamFrame{std::move(*color), std::move(*depth)};
}

}  // namespace fusebench::exports
