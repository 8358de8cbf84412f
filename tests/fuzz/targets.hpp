// Fuzz targets: each takes any bytes as one input file, reads it, and throws (check()) when a property of the
// reader does not hold. libFuzzer drives them in the preset fuzz (libfuzzer_entry.cpp, one program a target);
// corpus_test.cpp replays the committed inputs in every build with tests.
#pragma once

#include <array>
#include <string_view>

namespace fusebench::fuzz {

void text_table(std::string_view bytes);
void trajectory(std::string_view bytes);
void trajectory_formats(std::string_view bytes);
void image_list(std::string_view bytes);
void side_files(std::string_view bytes);
void calibration(std::string_view bytes);
void ply(std::string_view bytes);
void png(std::string_view bytes);
void zr300(std::string_view bytes);
void infinitam(std::string_view bytes);
void icl(std::string_view bytes);
void sens(std::string_view bytes);
void zip_archive(std::string_view bytes);
void sensor_files(std::string_view bytes);
void stray(std::string_view bytes);
void rosbag(std::string_view bytes);
void obj(std::string_view bytes);
void record(std::string_view bytes);
void config(std::string_view bytes);
void gates(std::string_view bytes);

struct Target {
  std::string_view name;  ///< also its folder below tests/fuzz/corpus
  void (*run)(std::string_view bytes);
};

inline constexpr std::array kTargets = {
    Target{"text_table", text_table},
    Target{"trajectory", trajectory},
    Target{"trajectory_formats", trajectory_formats},
    Target{"image_list", image_list},
    Target{"side_files", side_files},
    Target{"calibration", calibration},
    Target{"ply", ply},
    Target{"png", png},
    Target{"zr300", zr300},
    Target{"infinitam", infinitam},
    Target{"icl", icl},
    Target{"sens", sens},
    Target{"zip_archive", zip_archive},
    Target{"sensor_files", sensor_files},
    Target{"stray", stray},
    Target{"rosbag", rosbag},
    Target{"obj", obj},
    Target{"record", record},
    Target{"config", config},
    Target{"gates", gates},
};

}  // namespace fusebench::fuzz
