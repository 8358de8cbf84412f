#include "core/base/trajectory/pose_columns.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string_view>

#include "core/base/io/row_text.hpp"

namespace fusebench {

using namespace trajectory;

namespace {

Result<NamedColumns> columns_of(std::string_view line) { return columns_by_name(io::column_names(line)); }

void expect_columns(std::string_view line, const PoseColumns& expected) {
  const auto found = columns_of(line);
  ASSERT_TRUE(found) << line << ": " << found.error().message;
  EXPECT_EQ(found->columns.stamp, expected.stamp) << line;
  EXPECT_EQ(found->columns.position, expected.position) << line;
  EXPECT_EQ(found->columns.quaternion, expected.quaternion) << line;
  EXPECT_EQ(found->columns.unit, expected.unit) << line;
  EXPECT_EQ(found->columns.metres_per_unit, expected.metres_per_unit) << line;
}

constexpr auto kNanoseconds = io::TimeUnit::nanoseconds;

TEST(PoseColumns, NamesOfPublishedFormats) {
  expect_columns("# timestamp tx ty tz qx qy qz qw", {});
  expect_columns("#Time px py pz qx qy qz qw", {});
  expect_columns("#timestamp x y z qx qy qz qw id", {});
  expect_columns("# timestamp(s) tx ty tz qx qy qz qw Pr11 Pr12", {.unit = io::TimeUnit::seconds});
  expect_columns("#ts (ns),tx (m),ty (m),tz (m),qx,qy,qz,qw", {.unit = kNanoseconds});
  expect_columns("# timestamp [ns] tx [m] ty [m] tz [m] qx [] qy [] qz [] qw []", {.unit = kNanoseconds});
  expect_columns("# format: timestamp tx ty tz qx qy qz qw", {});
  expect_columns("timestamp_us,position.x,position.y,position.z,rot_x,rot_y,rot_z,rot_w",
                 {.unit = io::TimeUnit::microseconds});
  expect_columns("time_in_ms,posX,posY,posZ,quatX,quatY,quatZ,quatW", {.unit = io::TimeUnit::milliseconds});
  expect_columns("\"\",\"t\",\"x\",\"y\",\"z\",\"qw\",\"qx\",\"qy\",\"qz\"",
                 {.stamp = 1, .position = {2, 3, 4}, .quaternion = {6, 7, 8, 5}});
}

TEST(PoseColumns, VelocitiesAndBiasesAreNoPose) {
  expect_columns(
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
      "v_RS_R_x [m "
      "s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], b_w_RS_S_y [rad s^-1], b_w_RS_S_z "
      "[rad "
      "s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], b_a_RS_S_z [m s^-2]",
      kEurocColumns);
  expect_columns(
      "t,wx,wy,wz,ax,ay,az,vx,vy,vz,vel_x,bw_x,tx,ty,tz,qx,qy,qz,qw,tx_std,linear.x,angular.x,cov_x,gyro_x",
      {.position = {12, 13, 14}, .quaternion = {15, 16, 17, 18}});
}

TEST(PoseColumns, MessagesOfRos) {
  const auto pose = columns_of(
      "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.pose.position.x,field.pose."
      "position.y,"
      "field.pose.position.z,field.pose.orientation.x,field.pose.orientation.y,field.pose.orientation.z,"
      "field.pose."
      "orientation.w");
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_EQ(pose->columns.stamp, 2U) << "the stamp of the header, not the time of recording";
  EXPECT_EQ(pose->other_stamp, "time");
  EXPECT_EQ(pose->columns.position, (std::array<std::size_t, 3>{4, 5, 6}));
  EXPECT_EQ(pose->columns.quaternion, (std::array<std::size_t, 4>{7, 8, 9, 10}));
  expect_columns(
      "Time,child_frame_id,pose.pose.position.x,pose.pose.position.y,pose.pose.position.z,pose.pose."
      "orientation.x,pose."
      "pose.orientation.y,pose.pose.orientation.z,pose.pose.orientation.w,twist.twist.linear.x,twist.twist."
      "angular.x",
      {.position = {2, 3, 4}, .quaternion = {5, 6, 7, 8}});
}

TEST(PoseColumns, StampsInTwoColumnsAreSecondsAndAFraction) {
  const auto expect_fraction = [](std::string_view line, std::size_t seconds, std::size_t fraction,
                                  io::TimeUnit unit) {
    const auto found = columns_of(line);
    ASSERT_TRUE(found) << line << ": " << found.error().message;
    EXPECT_EQ(found->columns.stamp, seconds) << line;
    EXPECT_EQ(found->columns.unit, io::TimeUnit::seconds) << line;
    EXPECT_EQ(found->columns.fraction, fraction) << line;
    EXPECT_EQ(found->columns.fraction_unit, unit) << line;
    EXPECT_EQ(found->other_stamp, "") << line;
  };
  expect_fraction("header.stamp.secs,header.stamp.nsecs,x,y,z,qx,qy,qz,qw", 0, 1, kNanoseconds);
  expect_fraction("# sec nanosec frame_id x y z qx qy qz qw", 0, 1, kNanoseconds);
  expect_fraction("id,time_usec,time_sec,x,y,z,qx,qy,qz,qw", 2, 1, io::TimeUnit::microseconds);
  EXPECT_FALSE(columns_of("t_us,t_ns,x,y,z,qx,qy,qz,qw")) << "neither is in seconds";
  expect_columns("sec,x,y,z,qx,qy,qz,qw", {.unit = io::TimeUnit::seconds});
}

TEST(PoseColumns, TablesWithColumnsBefore) {
  expect_columns("num,t,x,y,z,qx,qy,qz,qw", {.stamp = 1, .position = {2, 3, 4}, .quaternion = {5, 6, 7, 8}});
  expect_columns("timestamp, frame, x, y, z, qx, qy, qz, qw, fx, fy, cx, cy",
                 {.position = {2, 3, 4}, .quaternion = {5, 6, 7, 8}});
  expect_columns("index,time,qw,qx,qy,qz,tx,ty,tz",
                 {.stamp = 1, .position = {6, 7, 8}, .quaternion = {3, 4, 5, 2}});
}

TEST(PoseColumns, UnitsOfPositions) {
  expect_columns("t,x [mm],y [mm],z [mm],qx,qy,qz,qw", {.metres_per_unit = 1e-3});
  expect_columns("t,tx_cm,ty_cm,tz_cm,qx,qy,qz,qw", {.metres_per_unit = 1e-2});
  EXPECT_FALSE(columns_of("t,x [mm],y [m],z [m],qx,qy,qz,qw"));
}

TEST(PoseColumns, MissingAndRepeatedNamesAreNamed) {
  const auto expect_fault = [](std::string_view line, std::string_view part) {
    const auto found = columns_of(line);
    ASSERT_FALSE(found) << line;
    EXPECT_NE(found.error().message.find(part), std::string::npos) << found.error().message;
  };
  expect_fault("t,tx,ty,tz,qx,qy,qz", "no column is named as the w of the quaternion (qw)");
  expect_fault("t,tx,ty,qx,qy,qz,qw", "no column is named as the z of the position (tz)");
  expect_fault("id,tx,ty,tz,qx,qy,qz,qw", "no column is named as the stamp");
  expect_fault("t,gt_tx,est_tx,ty,tz,qx,qy,qz,qw", "gt_tx and est_tx");
  expect_fault("t,x,y,z,roll,pitch,yaw", "quaternion");
  expect_fault("", "stamp");
}

}  // namespace
}  // namespace fusebench
