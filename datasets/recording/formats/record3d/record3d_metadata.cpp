#include "datasets/recording/formats/record3d/record3d_metadata.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "datasets/calibration/frame_cameras.hpp"
#include "datasets/recording/reading/json_file.hpp"

namespace fusebench::formats::record3d {

namespace {

/// What is used, and what does not change how images are read.
constexpr std::array<std::string_view, 11> kKnownKeys = {"w",
                                                         "h",
                                                         "K",
                                                         "fps",
                                                         "dw",
                                                         "dh",
                                                         "initPose",
                                                         "poses",
                                                         "cameraType",
                                                         "perFrameIntrinsicCoeffs",
                                                         "frameTimestamps"};
constexpr double kMost_m = 1e7;
constexpr double kMost_s = 1e9;

tl::unexpected<Error> wrong(const std::filesystem::path& file, const std::string& what) {
  return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", file.string(), what));
}

/// ARKit's camera has y up and looks along -z.
SE3 with_y_down(const SE3& T_world_arkit) {
  return T_world_arkit * SE3{Quaterniond(0, 1, 0, 0), Vector3d::Zero()};
}

Result<std::vector<SE3>> read_poses(const nlohmann::json& document, const std::filesystem::path& file) {
  std::vector<SE3> poses;
  const auto found = document.find("poses");
  if (found == document.end()) return poses;
  if (!found->is_array()) return wrong(file, "poses must be a list");
  bool moves = false;
  for (std::size_t k = 0; k < found->size(); ++k) {
    const std::string key = fmt::format("poses[{}]", k);
    const auto p = reading::json_numbers({{key, (*found)[k]}}, key, 7, file);
    if (!p) return tl::unexpected(p.error());
    const Quaterniond q((*p)[3], (*p)[0], (*p)[1], (*p)[2]);
    const Vector3d t_m((*p)[4], (*p)[5], (*p)[6]);
    if (!(q.norm() > 0.5 && q.norm() < 2 && t_m.cwiseAbs().maxCoeff() <= kMost_m))
      return wrong(file, fmt::format("{}: its quaternion (x, y, z, w) is not of unit length, or its position "
                                     "is beyond {:g} m",
                                     key, kMost_m));
    poses.push_back(with_y_down({q.normalized(), t_m}));
    moves = moves || pose_minus(poses.back(), poses.front()).norm() > 1e-9;
  }
  if (!moves) poses.clear();
  return poses;
}

Result<std::vector<std::int64_t>> read_times(const nlohmann::json& document,
                                             const std::filesystem::path& file) {
  std::vector<std::int64_t> times_ns;
  const auto found = document.find("frameTimestamps");
  if (found == document.end()) return times_ns;
  const auto times_s = reading::json_numbers(document, "frameTimestamps", found->size(), file);
  if (!times_s) return tl::unexpected(times_s.error());
  for (const double time_s : *times_s) {
    if (!(std::abs(time_s) <= kMost_s))
      return wrong(file, fmt::format("frameTimestamps: {} s (allowed up to {:g} s)", time_s, kMost_s));
    times_ns.push_back(std::llround(1e9 * time_s));
    if (times_ns.size() > 1 && times_ns.back() <= times_ns[times_ns.size() - 2])
      return wrong(file, fmt::format("frameTimestamps do not rise at frame {}", times_ns.size() - 1));
  }
  return times_ns;
}

/// perFrameIntrinsicCoeffs, a list of [fx, fy, cx, cy]: the camera refocuses.
Result<void> take_frame_cameras(const nlohmann::json& document, const std::filesystem::path& file,
                                Record3dMetadata& metadata, std::vector<std::string>& warnings) {
  constexpr const char* kKey = "perFrameIntrinsicCoeffs";
  const auto found = document.find(kKey);
  if (found == document.end() || found->empty()) return {};
  if (!found->is_array()) return wrong(file, fmt::format("{} must be a list", kKey));
  std::vector<calibration::FrameCamera> cameras;
  for (std::size_t k = 0; k < found->size(); ++k) {
    const std::string key = fmt::format("{}[{}]", kKey, k);
    const auto c = reading::json_numbers({{key, (*found)[k]}}, key, 4, file);
    if (!c) return tl::unexpected(c.error());
    if (!((*c)[0] > 0 && (*c)[1] > 0)) return wrong(file, key + ": focal lengths must be above 0");
    PinholeCamera camera = metadata.camera;
    camera.fx_px = (*c)[0];
    camera.fy_px = (*c)[1];
    camera.cx_px = (*c)[2];
    camera.cy_px = (*c)[3];
    cameras.push_back({static_cast<std::int64_t>(k), camera});
  }
  const calibration::CommonCamera common = calibration::common_camera(cameras);
  if (!common.change.empty()) warnings.push_back(fmt::format("{}: {}", file.string(), common.change));
  metadata.camera = common.camera;
  return {};
}

}  // namespace

Result<Record3dMetadata> read_record3d_metadata(const std::filesystem::path& file,
                                                std::vector<std::string>& warnings) {
  const auto document = reading::read_json(file);
  if (!document) return tl::unexpected(document.error());
  const auto camera = reading::json_camera(*document, {"w", "h", "K"}, file);
  if (!camera) return tl::unexpected(camera.error());
  Record3dMetadata metadata;
  metadata.camera = *camera;
  if (const auto taken = take_frame_cameras(*document, file, metadata, warnings); !taken)
    return tl::unexpected(taken.error());
  reading::warn_of_unused_keys(*document, kKnownKeys, file, warnings);
  const auto fps = reading::json_frame_rate(*document, file, warnings);
  if (!fps) return tl::unexpected(fps.error());
  metadata.fps = *fps;
  auto times_ns = read_times(*document, file);
  if (!times_ns) return tl::unexpected(times_ns.error());
  metadata.timestamps_ns = std::move(*times_ns);
  auto poses = read_poses(*document, file);
  if (!poses) return tl::unexpected(poses.error());
  metadata.T_world_camera = std::move(*poses);
  return metadata;
}

}  // namespace fusebench::formats::record3d
