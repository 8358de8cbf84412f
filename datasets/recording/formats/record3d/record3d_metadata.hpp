// metadata.json of Record3D.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"
#include "core/base/types.hpp"

namespace fusebench::formats::record3d {

struct Record3dMetadata {
  PinholeCamera camera;  ///< of K, or the median of the frames' where they have their own
  std::optional<double> fps;
  std::vector<std::int64_t> timestamps_ns;  ///< of each frame; empty in older exports
  std::vector<SE3>
      T_world_camera;  ///< of each frame, camera with y down and z forward; empty where none moves
};

/// Keys that are not used are named in `warnings`. Errors name the file and the key: data_missing,
/// data_corrupt.
[[nodiscard]] Result<Record3dMetadata> read_record3d_metadata(const std::filesystem::path& file,
                                                              std::vector<std::string>& warnings);

}  // namespace fusebench::formats::record3d
