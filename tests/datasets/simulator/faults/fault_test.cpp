#include "datasets/simulator/faults/fault.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/simulator/faults/calibration_error.hpp"

namespace fusebench {

using namespace simulator::faults;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// Ten frames, a tenth of a second apart, on a clock that does not begin at zero.
std::vector<std::int64_t> ten_frames() {
  std::vector<std::int64_t> frame_ns;
  for (int k = 0; k < 10; ++k) frame_ns.push_back(7 * kSecond_ns + k * kSecond_ns / 10);
  return frame_ns;
}

std::string refusal(std::initializer_list<SimulatedFault> faults) {
  const auto valid = check_faults(std::vector<SimulatedFault>(faults), ten_frames());
  if (valid) return "taken";
  EXPECT_EQ(valid.error().code, ErrorCode::configuration);
  return valid.error().message;
}

TEST(Fault, TheTableIsInTheOrderOfTheKinds) {
  for (const FaultDescription& kind : fault_kinds()) {
    EXPECT_EQ(&describe(kind.kind), &kind) << kind.name;
    EXPECT_EQ(kind.amount.empty(), kind.most == 0) << kind.name;
    EXPECT_LE(kind.least, kind.usual) << kind.name;
    EXPECT_LE(kind.usual, kind.most) << kind.name;
  }
}

TEST(Fault, EveryKindIsReadBackFromItsText) {
  for (const FaultDescription& kind : fault_kinds()) {
    const SimulatedFault fault{kind.kind, 0.1, 2.5, kind.amount.empty() ? 0 : kind.most};
    const auto again = parse_fault(to_string(fault));
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->kind, fault.kind);
    EXPECT_EQ(again->begin_s, fault.begin_s);
    EXPECT_EQ(again->end_s, fault.end_s);
    EXPECT_EQ(again->amount, fault.amount);
  }
  EXPECT_EQ(parse_fault("hand=1:2")->amount, describe(FaultKind::hand).usual);
}

TEST(Fault, OtherTextsAreRefused) {
  const auto message = [](const char* text) {
    const auto fault = parse_fault(text);
    if (fault) return std::string("taken");
    EXPECT_EQ(fault.error().code, ErrorCode::usage);
    EXPECT_NE(fault.error().hint.find("KIND=BEGIN:END"), std::string::npos);
    return fault.error().message;
  };
  EXPECT_NE(message("black").find("has no '='"), std::string::npos);
  EXPECT_NE(message("dark=1:2").find("kind = dark (allowed: black, no-depth"), std::string::npos);
  EXPECT_NE(message("black=1").find("has 1 numbers (black takes BEGIN:END)"), std::string::npos);
  EXPECT_NE(message("black=1:2:3").find("has 3 numbers"), std::string::npos);
  EXPECT_NE(message("hand=1:2:3:4").find("BEGIN:END:AMOUNT"), std::string::npos);
  for (const char* text : {"black=", "black=:", "black=1:", "black=a:2", "black=1:2s", "black=1:nan",
                           "black=1:inf", "black=1 :2", "hand=1:2:"}) {
    EXPECT_NE(message(text).find("is no number"), std::string::npos) << text;
  }
}

TEST(Fault, HoldsFromItsBeginToBeforeItsEnd) {
  const SimulatedFault fault{FaultKind::black, 0.1, 0.3, 0};
  EXPECT_FALSE(fault.holds_at(99'999'999));
  EXPECT_TRUE(fault.holds_at(100'000'000));
  EXPECT_TRUE(fault.holds_at(299'999'999));
  EXPECT_FALSE(fault.holds_at(300'000'000));
}

TEST(Fault, NonsenseIsRefused) {
  using enum FaultKind;
  EXPECT_EQ(refusal({{black, 0, 1, 0}}), "taken");
  EXPECT_NE(refusal({{black, -0.1, 1, 0}}).find("begins before"), std::string::npos);
  EXPECT_NE(refusal({{black, 0.5, 0.5, 0}}).find("end after"), std::string::npos);
  EXPECT_NE(refusal({{black, std::nan(""), 1, 0}}).find("begins before"), std::string::npos);
  EXPECT_NE(refusal({{black, 0.91, 5, 0}}).find("no frame is within it (frames are at 0 .. 0.9 s)"),
            std::string::npos);
  EXPECT_NE(refusal({{no_depth, 0.11, 0.19, 0}}).find("no frame"), std::string::npos);
  EXPECT_NE(refusal({{hand, 0, 1, 0.95}}).find("share of the colour image = 0.95 (allowed 0.02 .. 0.9)"),
            std::string::npos);
  EXPECT_NE(refusal({{brightness, 0, 1, 0}}).find("factor on all light = 0"), std::string::npos);
  EXPECT_NE(refusal({{brightness, 0, 1, std::nan("")}}).find("= nan"), std::string::npos);
  EXPECT_EQ(refusal({{blur, 0, 1, 0.1}}), "taken");
  const std::vector<std::int64_t> quick{0, kSecond_ns / 30, kSecond_ns / 15};
  const std::vector<SimulatedFault> long_exposure{{blur, 0, 1, 0.05}};
  const auto valid = check_faults(long_exposure, quick);
  ASSERT_FALSE(valid);
  EXPECT_NE(valid.error().message.find("longer than the 0.03333 s"), std::string::npos)
      << valid.error().message;
}

TEST(Fault, OneKindHoldsOnceAtATime) {
  using enum FaultKind;
  const std::string message = refusal({{hand, 0, 0.5, 0.3}, {black, 0, 1, 0}, {hand, 0.4, 1, 0.3}});
  EXPECT_NE(message.find("hand=0:0.5:0.3 and hand=0.4:1:0.3 are of one kind and overlap"), std::string::npos)
      << message;
  EXPECT_NE(refusal({{hand, 0, 0.5, 0.3}, {person, 0.4, 1, 1.5}})
                .find("hand=0:0.5:0.3 and person=0.4:1:1.5 both move before the camera and overlap"),
            std::string::npos);
  EXPECT_EQ(refusal({{hand, 0, 0.5, 0.3}, {hand, 0.5, 1, 0.3}}), "taken");
  EXPECT_EQ(refusal({{hand, 0, 0.5, 0.3}, {person, 0.5, 1, 1.5}}), "taken");
  EXPECT_EQ(refusal({{hand, 0, 0.5, 0.3}, {blur, 0, 0.5, 0.03}}), "taken");
}

TEST(Fault, DroppingLeavesARecording) {
  using enum FaultKind;
  EXPECT_NE(refusal({{drop, 0, 0.5, 0}}).find("first frame cannot be missing"), std::string::npos);
  EXPECT_NE(refusal({{drop, 0.1, 5, 0}}).find("leave 1 frame"), std::string::npos);
  EXPECT_EQ(refusal({{drop, 0.2, 5, 0}}), "taken");
  const std::vector<SimulatedFault> faults{{drop, 0.2, 0.4, 0}, {drop, 0.8, 0.9, 0}};
  const std::vector<bool> expected{false, false, true, true, false, false, false, false, true, false};
  EXPECT_EQ(dropped_frames(faults, ten_frames()), expected);
}

TEST(Fault, FaultsAddUpWithinAFrame) {
  using enum FaultKind;
  const std::vector<SimulatedFault> faults{
      {black, 0, 1, 0}, {hand, 1, 3, 0.4}, {brightness, 2, 3, 1.8}, {blur, 2, 3, 0.02}};
  const FrameFaults first = faults_at(faults, 0);
  EXPECT_TRUE(first.black && first.no_depth);
  EXPECT_FALSE(first.hand || first.exposure_s || first.no_texture || first.dropped);
  EXPECT_EQ(first.brightness, 1);
  const FrameFaults last = faults_at(faults, 2 * kSecond_ns);
  EXPECT_FALSE(last.black || last.no_depth);
  EXPECT_EQ(last.hand, 1U);
  EXPECT_EQ(last.brightness, 1.8);
  EXPECT_EQ(last.exposure_s, 0.02);
}

TEST(CalibrationError, HasTheRequestedSizeInSeededDirections) {
  const SE3 truth{so3_exp({0.1, -0.2, 0.3}), {0.09, 0.003, 0.002}};
  const CalibrationError error{1.5, 2};
  const SE3 wrong = miscalibrated(truth, error, 1);
  EXPECT_NEAR(rotation_angle_rad(truth.rotation, wrong.rotation), radians(1.5), 1e-12);
  EXPECT_NEAR((wrong.translation - truth.translation).norm(), 0.02, 1e-12);
  const SE3 other = miscalibrated(truth, error, 2);
  EXPECT_GT((wrong.translation - other.translation).norm(), 1e-3);
  EXPECT_GT(rotation_angle_rad(wrong.rotation, other.rotation), 1e-3);
  const SE3 none = miscalibrated(truth, {}, 1);
  EXPECT_EQ(none.translation, truth.translation);
  EXPECT_EQ(none.rotation.coeffs(), truth.rotation.coeffs());
}

TEST(CalibrationError, OtherTextsAndValuesAreRefused) {
  const auto error = parse_calibration_error("1.5:2");
  ASSERT_TRUE(error);
  EXPECT_EQ(error->rotation_deg, 1.5);
  EXPECT_EQ(error->shift_cm, 2);
  for (const char* text : {"", "1", "1:", ":1", "1:2:3", "1:2cm", "a:b"}) {
    const auto refused = parse_calibration_error(text);
    ASSERT_FALSE(refused) << text;
    EXPECT_EQ(refused.error().code, ErrorCode::usage);
    EXPECT_NE(refused.error().message.find("DEGREES:CENTIMETRES"), std::string::npos);
  }
  EXPECT_TRUE(check_calibration_error({45, 50}));
  for (const CalibrationError& wrong : {CalibrationError{46, 0}, CalibrationError{-1, 0},
                                        CalibrationError{std::nan(""), 0}, CalibrationError{0, 51}}) {
    EXPECT_FALSE(check_calibration_error(wrong));
  }
}

}  // namespace
}  // namespace fusebench
