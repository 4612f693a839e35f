// What drivers say, in messages of their own definitions, and bags of it.
#include "ros/convert.h"
#include "ros/device_messages.h"
#include "support/bodies.h"
#include "support/mesh_checks.h"
#include "tissue/simulate/scene_file.h"
#include "tools/bag_run.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>

#include <cmath>
#include <cstdio>

namespace {

using namespace tissue_ros;
using tissue_test::refusal;

// As it comes over the wire.
template <class Message>
AnyMessage any(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, message);
  AnyMessage result;
  result.morph(ros::message_traits::md5sum(message), ros::message_traits::datatype(message),
               ros::message_traits::definition(message), "");
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  result.read(in);
  return result;
}

geometry_msgs::PoseStamped sound_pose() {
  geometry_msgs::PoseStamped pose;
  pose.header.stamp = ros::Time(1.0);
  pose.header.frame_id = "patient";
  pose.pose.orientation.w = 1.0;
  return pose;
}

DeviceReader reader(const std::string& input = "", const tf2_ros::Buffer* transforms = nullptr) {
  const tissue::SceneDescription scene = tissue::parse_scene(
      "model: linear\ntools: [{name: arm, mode: grasp, input: {" + input + "}}]\n");
  return {scene.tools[0], 0, "patient", transforms};
}

TEST(DeviceReader, P1_P2_NamesWhatIsWrongWithAPose) {
  EXPECT_EQ(reader().pose(any(sound_pose())).stamp, 1000000000);
  auto pose = sound_pose();
  pose.pose.position.y = HUGE_VAL;
  EXPECT_EQ(refusal([&] { reader().pose(any(pose)); }),
            "E_NONFINITE: arm/measured_cp: position is not finite");
  pose.pose.position.y = 1e200;
  EXPECT_EQ(refusal([&] { reader().pose(any(pose)); }),
            "E_PARAM: arm/measured_cp: position is farther than 1e+06 m away");
  for (const double w : {0.0, 0.89, 1.11, std::nan("")}) {
    pose = sound_pose();
    pose.pose.orientation.w = w;
    EXPECT_EQ(refusal([&] { reader().pose(any(pose)); }).substr(0, 44),
              "E_PARAM: arm/measured_cp: orientation has no")
        << w;
  }
  for (const double w : {0.91, 1.09}) {
    pose = sound_pose();
    pose.pose.orientation.w = w;
    EXPECT_NO_THROW(reader().pose(any(pose))) << w;
  }
  pose = sound_pose();
  pose.header.stamp = ros::Time();
  EXPECT_EQ(refusal([&] { reader().pose(any(pose)); }),
            "E_PARAM: arm/measured_cp: header.stamp is 0, which marks what is invalid");
  EXPECT_EQ(refusal([&] { reader().pose(any(sensor_msgs::Joy())); }),
            "E_PARAM: arm/measured_cp: sensor_msgs/Joy is not geometry_msgs/PoseStamped or "
            "TransformStamped");
}

TEST(DeviceReader, P6_WaitsForNoTransform) {
  const tf2_ros::Buffer empty;
  auto pose = sound_pose();
  EXPECT_NO_THROW(reader("", &empty).pose(any(pose)));
  pose.header.frame_id = "/patient";
  EXPECT_NO_THROW(reader("", &empty).pose(any(pose)));
  for (const std::string& frame : {std::string("nowhere"), std::string(), std::string(300, 'x')}) {
    pose.header.frame_id = frame;
    EXPECT_EQ(refusal([&] { reader("", &empty).pose(any(pose)); }).substr(0, 7), "E_FRAME");
    EXPECT_EQ(refusal([&] { reader().pose(any(pose)); }).substr(0, 7), "E_FRAME");
  }
  // What a log is told of it stays short.
  EXPECT_LT(refusal([&] { reader("", &empty).pose(any(pose)); }).size(), 200u);
}

// Geomagic_Touch_ROS_Drivers name the frame /map, ros_geomagic speaks millimetres in `world`.
TEST(DeviceReader, ReadsTransformsOtherUnitsAndFramesThatMeanNothing) {
  geometry_msgs::TransformStamped transform;
  transform.header = sound_pose().header;
  transform.header.frame_id = "/map";
  transform.transform.translation.x = 20.0;
  transform.transform.rotation.z = 1.0;
  const tissue::ToolSample sample = reader("scale: 0.001, frame: patient").pose(any(transform));
  EXPECT_LE((sample.pose->position - tissue::Vec3(0.02, 0.0, 0.0)).norm(), 1e-15);
  EXPECT_EQ(sample.pose->orientation.z(), 1.0);
}

TEST(DeviceReader, AJawOrAButtonClosesATool) {
  sensor_msgs::JointState jaw;
  jaw.header.stamp = ros::Time(2.0);
  jaw.position = {0.05};
  const DeviceReader forceps = reader("jaw: arm/jaw/measured_js");
  EXPECT_TRUE(*forceps.grip(any(jaw))->closed);
  EXPECT_EQ(forceps.grip(any(jaw))->stamp, 2000000000);
  jaw.position = {0.3};
  EXPECT_FALSE(*forceps.grip(any(jaw))->closed);
  jaw.position.clear();
  EXPECT_EQ(refusal([&] { forceps.grip(any(jaw)); }),
            "E_PARAM: arm/jaw/measured_js: position is empty");
  sensor_msgs::Joy joy;
  joy.header.stamp = ros::Time(2.0);
  joy.buttons = {1};
  const DeviceReader stylus = reader("button: arm/button");
  EXPECT_TRUE(*stylus.grip(any(joy))->closed);
  joy.buttons = {0};
  EXPECT_FALSE(*stylus.grip(any(joy))->closed);
  joy.buttons = {2};
  EXPECT_FALSE(stylus.grip(any(joy)));
  EXPECT_EQ(refusal([&] { stylus.grip(any(jaw)); }),
            "E_PARAM: arm/button: sensor_msgs/JointState is not sensor_msgs/Joy");
}

// crtk_msgs/operating_state: Header header, string state, bool is_homed, bool is_busy.
AnyMessage operating_state(const std::string& state, std::size_t cut = 0) {
  std::vector<std::uint8_t> bytes(512);
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, std_msgs::Header());
  ros::serialization::serialize(out, state);
  ros::serialization::serialize(out, std::uint8_t{1});
  ros::serialization::serialize(out, std::uint8_t{0});
  bytes.resize(bytes.size() - out.getLength() - cut);
  AnyMessage result;
  result.morph("*", "crtk_msgs/operating_state", "", "");
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  result.read(in);
  return result;
}

TEST(DeviceReader, HonoursTheOperatingStateOfCrtk) {
  const DeviceReader arm = reader("state: arm/operating_state");
  EXPECT_TRUE(arm.is_enabled(operating_state("ENABLED")));
  for (const char* state : {"DISABLED", "PAUSED", "FAULT"}) {
    EXPECT_FALSE(arm.is_enabled(operating_state(state))) << state;
  }
  EXPECT_EQ(refusal([&] { arm.is_enabled(operating_state("ENABLED", 5)); }),
            "E_SIZE_MISMATCH: arm/operating_state: the message ends before its fields");
}

// Clouds of a bag, as bytes with their stamps.
std::vector<std::pair<std::uint64_t, std::vector<std::uint8_t>>> clouds_in(
    const std::string& path) {
  std::vector<std::pair<std::uint64_t, std::vector<std::uint8_t>>> result;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    const auto cloud = message.instantiate<sensor_msgs::PointCloud2>();
    result.emplace_back(cloud->header.stamp.toNSec(), cloud->data);
  }
  return result;
}

class BagRun : public testing::Test {
 protected:
  BagRun() : folder_(testing::TempDir()) {
    rosbag::Bag bag(bag_path(), rosbag::bagmode::Write);
    for (int i = 0; i < 40; ++i) {
      auto pose = sound_pose();
      pose.header.stamp = ros::Time(10.0 + 0.02 * i);
      pose.pose.position.z = 0.036 - 0.0002 * i;
      bag.write("/finger/measured_cp", pose.header.stamp, pose);
    }
  }
  ~BagRun() override {
    std::remove(bag_path().c_str());
    std::remove(cloud_path().c_str());
  }
  std::string bag_path() const { return folder_ + "tissue_bag_run.bag"; }
  std::string cloud_path() const { return folder_ + "tissue_bag_run_clouds.bag"; }

  static tissue::Scene scene(const tissue::TetMesh& mesh, int threads) {
    return tissue::Scene(
        tissue::parse_scene("model: corotational\nmaterial: {young: [[0, 3e3]]}\n"
                            "anchors: [{plane: {axis: z, below: 20%}}]\n"
                            "tools: [{name: finger, shape: {sphere: 0.006}, mode: press}]\n"
                            "effects: [contact, inertia, damping]\n"),
        std::make_shared<tissue::Body>(tissue::body_of(mesh)), threads);
  }

 private:
  std::string folder_;
};

TEST_F(BagRun, TheSameCloudsAtTheirStampsWithOneThreadAndTwo) {
  tissue::TetMesh mesh = tissue_test::refined_ball(0.024);
  mesh.frame_id = "patient";
  std::vector<std::pair<std::uint64_t, std::vector<std::uint8_t>>> first;
  for (const int threads : {1, 2}) {
    tissue::Scene moved = scene(mesh, threads);
    const tissue::RunRecord record = run_bag(moved, mesh, {bag_path(), cloud_path(), 30.0});
    EXPECT_EQ(record.seconds.size(), 40u);
    const auto clouds = clouds_in(cloud_path());
    // One in 40 ms.
    EXPECT_EQ(clouds.size(), 20u);
    EXPECT_EQ(clouds.front().first, 10000000000u);
    EXPECT_NE(clouds.back().second, clouds.front().second);
    if (first.empty()) first = clouds;
    EXPECT_EQ(clouds, first) << threads;
  }
}

TEST_F(BagRun, WhatCannotBeReadIsRefused) {
  tissue::TetMesh mesh = tissue_test::refined_ball(0.024);
  mesh.frame_id = "patient";
  tissue::Scene moved = scene(mesh, 1);
  EXPECT_EQ(refusal([&] {
              run_bag(moved, mesh, {"/nowhere.bag", "", 30.0});
            }).substr(0, 26),
            "E_FILE: bag: '/nowhere.bag");
  mesh.frame_id = "elsewhere";
  EXPECT_EQ(refusal([&] {
              run_bag(moved, mesh, {bag_path(), "", 30.0});
            }),
            "E_FRAME: finger/measured_cp: frame 'patient' is not the mesh's, 'elsewhere'");
  {
    rosbag::Bag bag(bag_path(), rosbag::bagmode::Write);
    bag.write("/other/measured_cp", ros::Time(1.0), sound_pose());
  }
  EXPECT_EQ(refusal([&] {
              run_bag(moved, mesh, {bag_path(), "", 30.0});
            }),
            "E_FILE: bag: '" + bag_path() + "' has no pose of any tool on /finger/measured_cp");
}

}  // namespace
