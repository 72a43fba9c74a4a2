#include "machine_io/mtconnect/device_model.h"

#include <gtest/gtest.h>

#include "base/small_file.h"

namespace kerf {
namespace {

DevicesAnswer answer_of(const std::string& name) {
  const auto text = read_small_file(std::string(KERF_MTCONNECT_ANSWERS) + "/" + name, 1U << 20U);
  EXPECT_TRUE(text);
  auto probe = parse_probe(text ? *text : "");
  EXPECT_TRUE(probe) << (probe ? "" : probe.error());
  return probe ? *probe : DevicesAnswer{};
}

TEST(DeviceModel, linuxcnc_example) {
  const DevicesAnswer probe = answer_of("linuxcnc_probe.xml");
  EXPECT_EQ(probe.header.sender, "linuxcnc-mtconnect");
  ASSERT_EQ(probe.devices.size(), 1U);
  const auto device = choose_device(probe, "");
  ASSERT_TRUE(device);
  EXPECT_EQ((*device)->name, "mtconnect_demo");
  ASSERT_TRUE((*device)->kinematics);
  EXPECT_EQ((*device)->kinematics->module, "trivkins");
  const auto plan = plan_items(**device, {});
  ASSERT_TRUE(plan) << plan.error();
  EXPECT_EQ(plan->letters(), "X Y Z");
  EXPECT_EQ(plan->axes[0]->id, "pos_x");
  EXPECT_EQ(plan->axes[2]->id, "pos_z");
  // Of an inch machine: 10 and -8 .. 0.12 inches.
  EXPECT_EQ(plan->least[0], -254);
  EXPECT_EQ(plan->most[1], 254);
  EXPECT_EQ(plan->least[2], -203.2);
  EXPECT_EQ(plan->most[2], 3.048);
  EXPECT_EQ(plan->tool->id, "toolnum");
  EXPECT_EQ(plan->line->id, "line");
  EXPECT_EQ(plan->execution, "execution");
  EXPECT_EQ(plan->mode, "mode");
  EXPECT_EQ(plan->spindle->id, "spdl_speed");
  EXPECT_EQ(plan->direction, "spdl_dir");
  EXPECT_EQ(plan->tool_offsets, "tooloffset");
  EXPECT_EQ(plan->availability, "avail");
  EXPECT_FALSE(plan->load);
  MtconnectSettings commanded;
  commanded.commanded = true;
  EXPECT_EQ(plan_items(**device, commanded)->axes[1]->id, "poscmd_y");
}

TEST(DeviceModel, a_mill_of_cppagent) {
  const DevicesAnswer probe = answer_of("mill_probe.xml");
  EXPECT_EQ(probe.header.instance, 1772357400U);
  // 10:30 in a zone that is an hour ahead.
  EXPECT_EQ(probe.header.created.ns, 1772357400LL * 1'000'000'000);
  const DeviceModel& mill = probe.devices.at(0);
  const auto plan = plan_items(mill, {});
  ASSERT_TRUE(plan) << plan.error();
  EXPECT_EQ(plan->letters(), "X Y Z A");
  EXPECT_EQ(plan->axes[0]->id, "xm");  // neither the time series nor WORK
  EXPECT_EQ(plan->axes[0]->scale, 1);  // nativeUnits have become units already
  EXPECT_EQ(plan->axes[1]->scale, 25.4);
  EXPECT_EQ(plan->axes[2]->id, "zm");  // Z1
  EXPECT_EQ(plan->axes[3]->id, "am");
  EXPECT_EQ(plan->least[0], -20);
  EXPECT_EQ(plan->most[0], 500);
  EXPECT_NEAR(*plan->least[1], -254, 1e-9);
  EXPECT_NEAR(*plan->most[1], 304.8, 1e-9);
  EXPECT_FALSE(plan->least[2]);
  EXPECT_EQ(plan->spindle->id, "s1");
  EXPECT_EQ(plan->line->id, "ln");
  EXPECT_EQ(plan->tool_offsets, "");
}

TEST(DeviceModel, coordinates_of_the_workpiece) {
  const DevicesAnswer probe = answer_of("mill_probe.xml");
  MtconnectSettings settings;
  settings.workpiece = true;
  const auto plan = plan_items(probe.devices.at(0), settings);
  ASSERT_TRUE(plan) << plan.error();
  // X has one of its own, so the path's is not taken.
  EXPECT_EQ(plan->letters(), "X");
  EXPECT_EQ(plan->axes[0]->id, "xw");
  EXPECT_FALSE(plan->least[0]);
}

TEST(DeviceModel, chosen_items) {
  const DevicesAnswer probe = answer_of("mill_probe.xml");
  MtconnectSettings settings;
  settings.axes[0] = ChosenItem{"Xwork", 2, 5};
  settings.axes[1] = ChosenItem{"ym", 1, 0};
  settings.load = ChosenItem{"Sload", 1, 0};
  const auto plan = plan_items(probe.devices.at(0), settings);
  ASSERT_TRUE(plan) << plan.error();
  EXPECT_EQ(plan->letters(), "X Y");
  EXPECT_EQ(plan->axes[0]->id, "xw");
  EXPECT_EQ(plan->axes[0]->scale, 2);
  EXPECT_EQ(plan->axes[0]->offset, 5);
  EXPECT_EQ(plan->axes[1]->scale, 25.4);
  EXPECT_EQ(plan->load->id, "sl");
  settings.axes[2] = ChosenItem{"nobody", 1, 0};
  EXPECT_EQ(plan_items(probe.devices.at(0), settings).error(),
            "source.map.Z.item: device Mill has no data item 'nobody'");
  settings.axes[2] = ChosenItem{"am", 1, 0};
  EXPECT_EQ(plan_items(probe.devices.at(0), settings).error(),
            "data item am: 'DEGREE' is no unit of a length");
}

DeviceModel device_of(const std::string& components) {
  const auto probe = parse_probe(
      "<MTConnectDevices><Header instanceId='1' creationTime='2026-01-01T00:00:00Z'/><Devices>"
      "<Device name='D' uuid='u'><Components>" +
      components + "</Components></Device></Devices></MTConnectDevices>");
  EXPECT_TRUE(probe) << probe.error();
  return probe->devices.at(0);
}

std::string linear(const std::string& name, const std::string& item) {
  return "<Linear name='" + name + "'><DataItems><DataItem category='SAMPLE' id='i" + name +
         "' units='MILLIMETER' " + item + "/></DataItems></Linear>";
}

TEST(DeviceModel, faults_say_what_helps) {
  const std::string actual = "type='POSITION' subType='ACTUAL'";
  EXPECT_EQ(plan_items(device_of(linear("X", "type='POSITION' subType='COMMANDED'")), {}).error(),
            "device D tells no actual positions in MACHINE coordinates; source.position: commanded "
            "takes those that it has");
  EXPECT_EQ(plan_items(device_of(linear("X", actual + " coordinateSystem='WORK'")), {}).error(),
            "device D tells no actual positions in MACHINE coordinates; source.frame: workpiece "
            "takes those that it has");
  EXPECT_EQ(plan_items(device_of(""), {}).error(),
            "device D tells no actual positions in MACHINE coordinates");
  EXPECT_EQ(plan_items(device_of(linear("X1", actual) + linear("X2", actual)), {}).error(),
            "X is both X1 and X2: source.map.X.item says which one");
  // One that is called X alone is it.
  EXPECT_EQ(plan_items(device_of(linear("X1", actual) + linear("X", actual)), {})->axes[0]->id,
            "iX");
  EXPECT_EQ(plan_items(device_of("<Linear name='X'><DataItems><DataItem id='a' units='KILOGRAM' " +
                                 actual + "/></DataItems></Linear>"),
                       {})
                .error(),
            "data item a: 'KILOGRAM' is no unit of a length");
}

TEST(DeviceModel, a_path_where_axes_tell_nothing) {
  const std::string path =
      "<Path id='p'><DataItems><DataItem id='pp' type='PATH_POSITION' subType='ACTUAL' "
      "units='MILLIMETER_3D'/></DataItems></Path>";
  MtconnectSettings work;
  work.workpiece = true;
  const auto plan = plan_items(device_of(path), work);
  ASSERT_TRUE(plan) << plan.error();
  EXPECT_EQ(plan->letters(), "X Y Z");
  EXPECT_EQ(plan->path_position->id, "pp");
  // Where it does not say so, a path's position is that of the workpiece.
  EXPECT_FALSE(plan_items(device_of(path), {}));
}

TEST(DeviceModel, devices) {
  const auto probe = parse_probe(
      "<MTConnectDevices><Header instanceId='1' creationTime='2026-01-01T00:00:00Z'/><Devices>"
      "<Device name='A' uuid='1'/><Device name='B' uuid='2'/></Devices></MTConnectDevices>");
  ASSERT_TRUE(probe);
  EXPECT_EQ((*choose_device(*probe, "B"))->uuid, "2");
  EXPECT_EQ((*choose_device(*probe, "1"))->name, "A");
  EXPECT_EQ(choose_device(*probe, "").error(),
            "the agent has 2 devices (A, B); source.device says which one");
  EXPECT_EQ(choose_device(*probe, "C").error(),
            "the agent has no device C (source.device); it has A, B");
}

TEST(DeviceModel, no_probes) {
  EXPECT_EQ(parse_probe("<html/>").error(), "a document of html, and MTConnectDevices is wanted");
  EXPECT_EQ(parse_probe("<MTConnectDevices/>").error(), "the answer has no Header");
  EXPECT_EQ(parse_probe("<MTConnectDevices><Header instanceId='-1'/></MTConnectDevices>").error(),
            "Header: instanceId is '-1'");
  EXPECT_EQ(
      parse_probe("<MTConnectError><Errors><Error errorCode='NO_DEVICE'>which</Error></Errors>"
                  "</MTConnectError>")
          .error(),
      "NO_DEVICE: which");
  EXPECT_EQ(parse_probe("<MTConnectError><Errors><InternalError errorCode='INTERNAL_ERROR'>"
                        "<ErrorMessage>oh</ErrorMessage></InternalError></Errors></MTConnectError>")
                .error(),
            "INTERNAL_ERROR: oh");
}

}  // namespace
}  // namespace kerf
