// The text lists of an Intel ZR300 recording: FMDataset's (TIMESTAMP.txt, IMU.txt) and those which its
// recorder wrote (COLOR.txt, DEPTH.txt, GYRO.txt, ACCEL.txt). The unit of time of each list is found from its
// spacing and noted, since the recorder's headers say "ms" where nanoseconds follow.
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/error.hpp"
#include "datasets/recording/reading/image_list.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::zr300 {

/// Images of both sensors, each in strictly increasing time, paths complete.
struct Zr300Images {
  std::vector<reading::ListedImage> color;
  std::vector<reading::ListedImage> depth;
};

/// TIMESTAMP.txt: "timestamp colour-name depth-name". The stamp is the colour image's. Images are named by
/// their own times; where the colour names confirm that (each is its row's stamp), depth takes its time from
/// its name, else from the row. Names without a folder are in color/ and depth/; filtered: depth is taken
/// from filtered/. Depth images that are listed twice appear once. Errors, with file:line: data_missing (the
/// list or an image), data_corrupt (a row, the order in time, the unit).
[[nodiscard]] Result<Zr300Images> read_zr300_timestamps(const std::filesystem::path& folder, bool filtered,
                                                        recording::Recording& recording);

/// COLOR.txt and DEPTH.txt: "timestamp name", not associated. Otherwise as above.
[[nodiscard]] Result<Zr300Images> read_zr300_image_lists(const std::filesystem::path& folder, bool filtered,
                                                         recording::Recording& recording);

/// IMU.txt: "timestamp gx gy gz ax ay az". The recorder leaves out the accelerometer where its callbacks come
/// in another order; such rows keep their gyroscope, and the accelerometer is interpolated. Fills
/// recording.imu and imu_source. Errors as above.
[[nodiscard]] Result<void> read_zr300_imu(const std::filesystem::path& folder,
                                          recording::Recording& recording);

/// GYRO.txt "timestamp gx gy gz" (the recorder may append an accelerometer, which is ignored) and ACCEL.txt
/// "timestamp ax ay az": the same.
[[nodiscard]] Result<void> read_zr300_gyro_and_accel(const std::filesystem::path& folder,
                                                     recording::Recording& recording);

}  // namespace fusebench::formats::zr300
