#include "datasets/recording/reading/sensor_yaml.hpp"

#include <gtest/gtest.h>

#include "tests/support/expect_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace reading;
using testing::expect_contains;

namespace {

class SensorYamlFile : public testing::InTemporaryFolder {
 protected:
  Result<SensorYaml> read(std::string_view text) const {
    return SensorYaml::read(write("sensor.yaml", text));
  }
  [[nodiscard]] std::string refusal(std::string_view text) const {
    const auto yaml = read(text);
    EXPECT_FALSE(yaml) << text;
    return yaml ? std::string() : yaml.error().message;
  }
};

/// EuRoC's own, with its line ends and comments.
TEST_F(SensorYamlFile, EurocsCamera) {
  const auto yaml = read(
      "# General sensor definitions.\r\nsensor_type: camera\r\ncomment: VI-Sensor cam0 (MT9M034)\r\n\r\n"
      "T_BS:\r\n  cols: 4\r\n  rows: 4\r\n  data: [0.0148, -0.9998, 0.004, -0.02,\r\n"
      "         1.0, 0.0, 0.0, 0.5,\r\n         0.0, 0.0, 1.0, 1e-3,\r\n         0.0, 0.0, 0.0, 1.0]\r\n"
      "rate_hz: 20\r\nresolution: [752, 480]\r\nintrinsics: [458.654, 457.296, 367.215, 248.375] #fu, "
      "fv\r\n");
  ASSERT_TRUE(yaml) << yaml.error().message;
  EXPECT_EQ(yaml->text("sensor_type"), "camera");
  EXPECT_EQ(yaml->text("comment"), "VI-Sensor cam0 (MT9M034)");
  EXPECT_EQ(yaml->numbers("T_BS.data", 16)->at(11), 1e-3);
  EXPECT_EQ(yaml->number("rate_hz"), 20);
  EXPECT_EQ(yaml->numbers("intrinsics", 4)->at(3), 248.375);
}

TEST_F(SensorYamlFile, SequencesAndBracesAreNumbered) {
  const auto yaml = read(
      "%YAML:1.0\n---\nlist:\n- name: a\n  deep:\n    value: 1\n-\n  name: \"b\"\n- { name: c, deep: { "
      "value: 3 } }\nafter: [ ]\n");
  ASSERT_TRUE(yaml) << yaml.error().message;
  EXPECT_EQ(yaml->text("list.0.name"), "a");
  EXPECT_EQ(yaml->number("list.0.deep.value"), 1);
  EXPECT_EQ(yaml->text("list.1.name"), "b");
  EXPECT_EQ(yaml->text("list.2.name"), "c");
  EXPECT_EQ(yaml->number("list.2.deep.value"), 3);
  EXPECT_EQ(yaml->numbers("after", 0)->size(), 0);
}

TEST_F(SensorYamlFile, WhatIsNotReadIsNamed) {
  expect_contains(refusal("a: 1\nno colon\n"), "sensor.yaml:2: expected 'key: value', got 'no colon'");
  expect_contains(refusal("a: 1\na: 2\n"), "sensor.yaml:2: the key a stands there twice");
  expect_contains(refusal("a: [1, 2\nb: 3\n"), "sensor.yaml:2: a list is not closed");
  expect_contains(refusal("a: [1, 2] 3\n"), "sensor.yaml:1: brackets do not match, or something follows");
  expect_contains(refusal("a:\n\tb: 1\n"), "sensor.yaml:2: a tab indents the line");
  expect_contains(refusal("- 1\n"), "sensor.yaml:1: an item of a list without a key");
  expect_contains(SensorYaml::read(folder_ / "none.yaml").error().message, "none.yaml: no such file");
  expect_contains(SensorYaml::read(folder_).error().message, "cannot be read as a file");
  const auto yaml = read("a: [1, x]\nb: nan\n");
  ASSERT_TRUE(yaml);
  expect_contains(yaml->numbers("a", 2).error().message,
                  "sensor.yaml:1: a must be a list of 2 finite numbers");
  expect_contains(yaml->number("b").error().message, "sensor.yaml:2: b must be a finite number");
  expect_contains(yaml->number("c").error().message, "sensor.yaml: needs the key c");
  expect_contains(yaml->text("a").error().message, "sensor.yaml:1: a must be one value, not a list");
}

}  // namespace
}  // namespace fusebench
