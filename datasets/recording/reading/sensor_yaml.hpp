// The small part of YAML that describes sensors: EuRoC's sensor.yaml, and what OpenCV writes.
//
//     # comment, %YAML:1.0, ---        left out
//     key: value                       a scalar, to the end of the line or a comment
//     key: [1, 2,                      a list of scalars, which may go on over lines
//           3]
//     key: !!opencv-matrix             what is deeper indented belongs to it: "key.data"
//        data: [1, 2, 3, 4]
//     key:
//       - child: value                 an item of a sequence: "key.0.child"
//       - { child: value, ... }        the same on one line, also as the value of a key
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "datasets/calibration/camera_model.hpp"

namespace fusebench::reading {

/// One scalar or list of a file.
struct YamlValue {
  std::string key;                 ///< with those above it: "trans_matrix.0.parent_frame"
  std::vector<std::string> items;  ///< a scalar is one
  int line = 0;
};

class SensorYaml {
 public:
  /// Errors name file:line: data_missing; data_corrupt (what is none of the above, a key twice).
  [[nodiscard]] static Result<SensorYaml> read(const std::filesystem::path& file);

  [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
  [[nodiscard]] const std::vector<YamlValue>& values() const { return values_; }
  /// Errors data_corrupt: the key is not there, its value is no scalar, not `count` finite numbers.
  [[nodiscard]] Result<std::string> text(std::string_view key) const;
  [[nodiscard]] Result<double> number(std::string_view key) const;
  [[nodiscard]] Result<std::vector<double>> numbers(std::string_view key, std::size_t count) const;
  /// An error about the line of that key.
  [[nodiscard]] tl::unexpected<Error> fail_at(std::string_view key, std::string_view what) const;

 private:
  [[nodiscard]] const YamlValue* find(std::string_view key) const;

  std::string file_;
  std::vector<YamlValue> values_;
};

/// The distortion of a model's name and its coefficients; none if there are no coefficients. Errors
/// data_corrupt, with file:line: coefficients that are no list of finite numbers; a model that
/// calibration::distortion_of_model() does not support.
[[nodiscard]] Result<calibration::BrownConrady> yaml_distortion(const SensorYaml& yaml,
                                                                const std::string& model_key,
                                                                const std::string& coefficients_key);

}  // namespace fusebench::reading
