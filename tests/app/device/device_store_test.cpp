#include "app/device/device_store.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "app/device/device_hub.h"
#include "app/run/urdf_writer.h"
#include "devices/files/text_file.h"
#include "devices/files/urdf_file.h"
#include "tests/support/fake_device.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

DeviceStore written_and_read(const DeviceStore& store, const std::filesystem::path& file) {
  EXPECT_EQ(save_device_store({}, store, file), "");
  DeviceStore read = load_device_store(file);
  EXPECT_EQ(read.complaint(), "");
  return read;
}

std::string text_in(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(DeviceStore, RemembersTheDeviceInUseAndItsAxes) {
  const test::TempDir dir;
  DeviceStore store;
  store.in_use = "1209:4c50:a \"serial\" number";
  DeviceNotes& notes = store.notes[store.in_use];
  notes.axes = {{.zero = 0.25, .inverted = true},
                {.zero = -1.5, .scale = 0.4, .reversed = true},
                {.reversed = true}};
  notes.pid.effort = 1.75;
  notes.pid.range = 0.6;
  const DeviceStore read = written_and_read(store, dir / "below/devices.toml");
  EXPECT_EQ(read.in_use, store.in_use);
  ASSERT_EQ(read.notes.count(store.in_use), 1U);
  const DeviceNotes& again = read.notes.at(store.in_use);
  ASSERT_EQ(again.axes.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again.axes[i].zero, notes.axes[i].zero);
    EXPECT_EQ(again.axes[i].scale, notes.axes[i].scale);
    EXPECT_EQ(again.axes[i].inverted, notes.axes[i].inverted);
    EXPECT_EQ(again.axes[i].reversed, notes.axes[i].reversed);
  }
  EXPECT_EQ(again.pid.effort, 1.75);
  EXPECT_EQ(again.pid.range, 0.6);
}

TEST(DeviceStore, LowersLimits) {
  const test::TempDir dir;
  DeviceStore store;
  store.notes["id"].limits = {.tip_speed = 0.5, .tip_force = 3, .range = 0.8};
  const SafetyLimits read = written_and_read(store, dir / "devices.toml").notes["id"].limits;
  EXPECT_EQ(read.tip_speed, 0.5);
  EXPECT_EQ(read.tip_force, 3);
  EXPECT_EQ(read.range, 0.8);
  EXPECT_EQ(read.joint_speed, 15);
}

// Left out, it would be the widest one when the file is read again.
TEST(DeviceStore, RefusesToSaveALimitThatIsNoNumber) {
  const test::TempDir dir;
  const auto file = dir / "devices.toml";
  DeviceStore store;
  store.notes["1209:4c50:"].limits.tip_force = std::nan("");
  EXPECT_THAT(save_device_store({}, store, file),
              testing::HasSubstr("limits.tip_force: nan is not allowed"));
  EXPECT_FALSE(std::filesystem::exists(file));
}

// Each of these values once meant the widest limit, or an axis that is not inverted.
TEST(DeviceStore, RefusesADeviceOfWhichItCannotUnderstandOneValue) {
  const test::TempDir dir;
  const auto file = dir / "devices.toml";
  const struct {
    const char *line, *key, *found, *allowed;
  } kWrong[] = {{"limits = {tip_force = 0.05}", "limits.tip_force", "0.05", "from 0.1 up to 10"},
                {"limits = {tip_force = 100}", "limits.tip_force", "100", "from 0.1 up to 10"},
                {"limits = {tip_force = \"1\"}", "limits.tip_force", "\"1\"", "a number"},
                {"limits = {tip_speed = nan}", "limits.tip_speed", "nan", "a number"},
                {"limits = {energy = -1}", "limits.energy", "-1", "a number"},
                {"limits = 3", "limits", "3", "a table"},
                {"effort = -3.0", "effort", "-3", "a number from 0.01 up to 50"},
                {"range = \"20 degrees\"", "range", "\"20 degrees\"", "a number"},
                {"axis = [{inverted = \"yes\"}]", "axis[0].inverted", "\"yes\"", "true, false"},
                {"axis = [{}, {scale = 0.0}]", "axis[1].scale", "0", "a number"},
                {"axis = [7]", "axis", "[7]", "a list of tables"},
                {"reverse = [true, 1]", "reverse", "[true, 1]", "true or false"},
                {"reverse = true", "reverse", "true", "a list"},
                {"checked = 1", "checked", "1", "true, false"},
                {"arm = 7", "arm", "7", "text in quotes"},
                {"delay = \"2 ms\"", "delay", "\"2 ms\"", "a number"},
                {"torque_scale = 1000.5", "torque_scale", "1000.5", "a number"},
                {"compensation = {friction = 1.5}", "compensation.friction", "1.5", "a number"},
                {"compensation = {down = 'up'}", "compensation.down", "\"up\"", "file, -z, +z"},
                {"compensation = {springs = 3}", "compensation.springs", "3", "true, false"},
                {"limits = {tip_forse = 1}", "limits.tip_forse", "did you mean tip_force?",
                 "tip_force, energy"},
                {"limits = {force = 1}", "limits.force", "no such key", "tip_force, energy"},
                {"limits = {speed = 0.5}", "limits.speed", "no such key", "joint_speed, tip_speed"},
                {"limit = {tip_force = 1}", "limit", "a table", "the key \"limits\""},
                {"tip_force = 1.0", "tip_force", "1", "limits under [device."},
                {"safety = {tip_force = 1.0}", "safety", "a table", "limits under [device."},
                {"safety = [{tip_force = 1.0}]", "safety", "[a table]", "limits under [device."},
                {"force_limits = {x = 1}", "force_limits", "a table", "limits under [device."},
                {"\"limits.tip_force\" = 1.0", "limits.tip_force", "1", "limits under [device."},
                {"compensation = {tip_force = 1}", "compensation.tip_force", "1", "limits under"},
                {"axis = [{range = 1}]", "axis[0].range", "1", "limits under [device."},
                {"reversed = [true]", "reversed", "[true]", "the key \"reverse\""},
                {"axis = [{invertd = true}]", "axis[0].invertd", "true", "the key \"inverted\""}};
  for (const auto& [line, key, found, allowed] : kWrong) {
    std::ofstream(file) << "[device.good]\nchecked = true\n[device.\"1:2\"]\n" << line << "\n";
    const DeviceStore store = load_device_store(file);
    const std::string said = store.notes.at("1:2").refusal;
    EXPECT_THAT(said, testing::StartsWith(file.string() + ":4: device.\"1:2\"." + key + ": "));
    EXPECT_THAT(said, testing::HasSubstr(found)) << line;
    EXPECT_THAT(said, testing::HasSubstr(std::string("allowed: "))) << line;
    EXPECT_THAT(said, testing::HasSubstr(allowed)) << line;
    EXPECT_EQ(store.notes.at("good").refusal, "") << "it concerns one device only";
    EXPECT_TRUE(store.notes.at("good").checked);
    EXPECT_EQ(store.complaint(), said);
    EXPECT_EQ(store.refusal, "");
  }
}

TEST(DeviceStore, RefusesEverythingWhereTheFileItselfCannotBeUnderstood) {
  const test::TempDir dir;
  const auto file = dir / "devices.toml";
  for (const char* text :
       {"in_use = \n", "in_use = 7\n", "device = 3\n", "[device.a]\nchecked = true\n[device.a]\n",
        "[device.a]\n[devices.a.limits]\ntip_force = 1\n", "[limits]\ntip_force = 1\n",
        "tip_force = 1\n", "[safety]\nforce = 1\n", "[device.limits]\ntip_force = 1\n",
        "[device]\ntip_force = 1\n", "[device]\nchecked = true\n",
        "[device.a]\n[[device.axis]]\nscale = 2\n", "\xff\xfe"}) {
    std::ofstream(file) << text;
    const DeviceStore store = load_device_store(file);
    EXPECT_THAT(store.refusal, testing::StartsWith(file.string() + ":")) << text;
    EXPECT_EQ(store.complaint(), store.refusal);
  }
  std::filesystem::remove(file);
  std::filesystem::create_directory(file);
  EXPECT_NE(load_device_store(file).refusal, "") << "a folder in its place";
  EXPECT_EQ(load_device_store(dir / "none.toml").complaint(), "") << "a first start";
}

TEST(DeviceStore, TakesADeviceWhoseIdHasTheWordsOfALimit) {
  const test::TempDir dir;
  const auto file = dir / "devices.toml";
  std::ofstream(file) << "[device.\"socket:long_range\"]\nchecked = true\n"
                         "[device.\"socket:no_limit\"]\nchecked = true\n";
  const DeviceStore store = load_device_store(file);
  EXPECT_EQ(store.complaint(), "");
  EXPECT_TRUE(store.notes.at("socket:long_range").checked);
}

TEST(DeviceStore, IsNeverWrittenOverWhereItCannotBeUnderstood) {
  const test::TempDir dir;
  const auto file = dir / "devices.toml";
  for (const std::string text : {"in_use = \n[device.a.limits]\ntip_force = 1\n",
                                 "[device.a.limits]\ntip_force = \"1\"\n", "device = 3\n"}) {
    std::ofstream(file) << text;
    const DeviceStore before = load_device_store(file);
    DeviceStore now = before;
    now.notes["a"].pid.effort = 2;
    EXPECT_THAT(save_device_store(before, now, file), testing::HasSubstr(file.string()));
    EXPECT_EQ(text_in(file), text);
  }
}

TEST(DeviceStore, KeepsWhatOthersHaveWrittenMeanwhileAndKeysThatNobodyKnows) {
  const test::TempDir dir;
  const auto file = dir / "devices.toml";
  std::ofstream(file) << "future = 1\nin_use = \"a\"\n[device.a]\neffort = 1.0\nwarmth = 3\n"
                         "[device.a.limits]\ntip_force = 5.0\n[device.a.compensation]\nsmell = "
                         "2\n[device.b]\nrange = 0.5\n";
  const DeviceStore start = load_device_store(file);
  EXPECT_EQ(start.complaint(), "");
  DeviceStore window = start, identify = start, other = start;
  identify.notes["a"].delay = 0.002;
  identify.notes["a"].arm = "/found.urdf";
  other.notes["a"].limits.tip_force = 1;
  other.in_use = "b";
  window.notes["a"].limits.tip_speed = 0.5;
  window.notes["c"].checked = true;
  EXPECT_EQ(save_device_store(start, identify, file), "");
  EXPECT_EQ(save_device_store(start, other, file), "");
  EXPECT_EQ(save_device_store(start, window, file), "");
  const DeviceStore all = load_device_store(file);
  EXPECT_EQ(all.complaint(), "");
  EXPECT_EQ(all.in_use, "b");
  EXPECT_EQ(all.notes.at("a").delay, 0.002);
  EXPECT_EQ(all.notes.at("a").arm, "/found.urdf");
  EXPECT_EQ(all.notes.at("a").limits.tip_force, 1);
  EXPECT_EQ(all.notes.at("a").limits.tip_speed, 0.5);
  EXPECT_EQ(all.notes.at("a").pid.effort, 1);
  EXPECT_EQ(all.notes.at("b").pid.range, 0.5);
  EXPECT_TRUE(all.notes.at("c").checked);
  for (const char* key : {"future = 1", "warmth = 3", "smell = 2"}) {
    EXPECT_THAT(text_in(file), testing::HasSubstr(key));
  }
}

TEST(DeviceStore, ForgetsADelayThatWasTakenBack) {
  const test::TempDir dir;
  const auto file = dir / "devices.toml";
  std::ofstream(file) << "[device.a]\ndelay = 0.002\n";
  const DeviceStore before = load_device_store(file);
  DeviceStore now = before;
  now.notes["a"].delay = DeviceNotes{}.delay;
  EXPECT_EQ(save_device_store(before, now, file), "");
  EXPECT_TRUE(std::isnan(load_device_store(file).notes.at("a").delay));
}

// Many programs write at once, each its own entry; without the lock some would be lost.
TEST(DeviceStore, LosesNothingWhereManyWriteAtOnce) {
  const test::TempDir dir;
  const auto file = dir / "devices.toml";
  constexpr int kPrograms = 4, kEntries = 12;
  std::vector<pid_t> programs;
  for (int program = 0; program < kPrograms; ++program) {
    programs.push_back(fork());
    if (programs.back() != 0) continue;
    for (int i = 0; i < kEntries; ++i) {
      const DeviceStore before = load_device_store(file);
      DeviceStore now = before;
      now.notes[std::to_string(program * 100 + i)].checked = true;
      if (!save_device_store(before, now, file).empty()) _exit(1);
    }
    _exit(0);
  }
  for (const pid_t program : programs) {
    int status = -1;
    waitpid(program, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(load_device_store(file).notes.size(), std::size_t{kPrograms * kEntries});
}

// Checks joints that yield by a given angle per newton metre.
AxisCheck checked(const std::vector<double>& give) {
  AxisCheck check(test::pushing(static_cast<int>(give.size()), 0.35));
  std::vector<double> x(give.size());
  for (int i = 0; i < 20'000 && !check.done(); ++i) {
    const auto torque = check.step({x, 1e-3, true});
    for (std::size_t j = 0; j < give.size(); ++j) x[j] = give[j] * torque[j];
  }
  return check;
}

std::vector<bool> reversed(const DeviceNotes& notes) {
  std::vector<bool> all;
  for (const AxisAdjustment& axis : notes.axes) all.push_back(axis.reversed);
  return all;
}

TEST(DeviceStore, RemembersWhatACheckHasFoundOfAnyNumberOfJoints) {
  const test::TempDir dir;
  DeviceStore store;
  DeviceNotes& notes = store.notes["a"];
  notes.axes = {{.zero = 0.25}, {.reversed = true}};
  EXPECT_FALSE(notes.checked);
  EXPECT_TRUE(remember_check(checked({0.5, -0.5, -0.5}), notes));
  EXPECT_TRUE(notes.checked);
  EXPECT_EQ(reversed(notes), (std::vector{false, false, true})) << "the second: reversed once more";
  EXPECT_TRUE(remember_check(checked({-0.5, 0.5, 0.5}), notes));
  EXPECT_EQ(reversed(notes), (std::vector{true, false, true}));
  EXPECT_EQ(notes.axes[0].zero, 0.25);
  const DeviceNotes again = written_and_read(store, dir / "devices.toml").notes.at("a");
  EXPECT_TRUE(again.checked);
  EXPECT_EQ(again.checked_as, notes.checked_as);
  EXPECT_NE(again.checked_as, "");
  EXPECT_EQ(reversed(again), (std::vector{true, false, true}));
}

TEST(DeviceStore, RemembersNothingOfACheckThatFailed) {
  DeviceNotes notes;
  notes.axes = {{.reversed = true}, {}};
  EXPECT_FALSE(remember_check(checked({-0.5, 0}), notes));
  EXPECT_FALSE(notes.checked);
  EXPECT_EQ(reversed(notes), (std::vector{true, false}));
}

// The file dates from before there were checks.
TEST(DeviceStore, TakesTheJoysticksOfOldBooksForUnchecked) {
  const test::TempDir dir;
  const auto file = dir / "devices.toml";
  std::ofstream(file) << "in_use = \"a\"\n[device.a]\nrange = 0.6\neffort = 1.75\n"
                         "reverse = [true, false]\naxis = [{zero = 0.25, scale = 1.0, inverted = "
                         "true}]\n";
  EXPECT_EQ(load_device_store(file).complaint(), "");
  const DeviceNotes notes = load_device_store(file).notes.at("a");
  EXPECT_FALSE(notes.checked);
  EXPECT_EQ(reversed(notes), (std::vector{true, false}));
  EXPECT_EQ(notes.pid.range, 0.6);
  EXPECT_EQ(notes.pid.effort, 1.75);
  EXPECT_TRUE(notes.axes.at(0).inverted);
}

// A hub with a device of this kind in use, opened as a fake one.
struct AHub : testing::Test {
  static constexpr DeviceKind kPushes{.pushes = true};
  static constexpr DeviceKind kSaysSoItself{};
  static constexpr DeviceKind kLeadsHand{.leads_hand = true};
  static inline int opened = 0;
  static inline bool pushes = true;

  void SetUp() override {
    opened = 0;
    pushes = true;
  }
  void write(const std::string& text) const { std::ofstream(file) << text; }
  DeviceHub& hub(const DeviceKind& kind) {
    FoundDevice found;
    found.place = {"A device", "a", ""};
    found.kind = &kind;
    found.open = [](const FoundDevice&, const PidSettings&, const AskForPriority&, DeviceClaim) {
      ++opened;
      auto device = std::make_unique<test::FakeDevice>(3);
      device->own_traits().pushes = pushes;
      return std::unique_ptr<Device>(std::move(device));
    };
    found.claim_key = [](const FoundDevice&) { return fmt::format("test:{}", getpid()); };
    hub_.emplace(file, AskForPriority{});
    hub_->take({found});
    hub_->use("a");
    return *hub_;
  }
  std::string refusal_to_open() {
    try {
      hub_->opening()();
    } catch (const FileError& error) {
      return error.what();
    }
    return {};
  }

  const test::TempDir dir;
  const std::filesystem::path file = dir / "devices.toml";
  std::optional<DeviceHub> hub_;
};

TEST_F(AHub, LetsNoDeviceIntoTheLoopThatPushesAndWasNotChecked) {
  EXPECT_TRUE(hub(kPushes).needs_check());
  EXPECT_FALSE(hub(kSaysSoItself).needs_check()) << "nobody knows yet";
  EXPECT_THROW(hub_->opening()(), UncheckedError);
  EXPECT_EQ(opened, 1);
  hub_->notes("a").checked = true;
  EXPECT_NO_THROW(hub_->opening()());
  hub_->notes("a").checked_as = what_it_is("another", 3);
  EXPECT_THROW(hub_->opening()(), UncheckedError) << "under the id of one that was checked";
  hub_->notes("a").checked_as = what_it_is(test::pushing(3).name, 3);
  EXPECT_NO_THROW(hub_->opening()());
  hub_->notes("a").checked_as = what_it_is(test::pushing(2).name, 2);
  EXPECT_THROW(hub_->opening()(), UncheckedError);
  hub_->notes("a").checked = false;
  pushes = false;
  EXPECT_NO_THROW(hub_->opening()()) << "what has no motors needs no check";
  EXPECT_FALSE(hub(kLeadsHand).needs_check());
  hub_->use("");
  EXPECT_FALSE(hub_->needs_check()) << "none is in use";
}

TEST_F(AHub, OpensNothingThatItsBookRefuses) {
  write("[device.a]\nchecked = true\n[device.a.limits]\ntip_force = \"1\"\n");
  EXPECT_THAT(hub(kPushes).refusal(), testing::HasSubstr("limits.tip_force"));
  EXPECT_EQ(refusal_to_open(), hub_->refusal());
  EXPECT_THROW(hub_->checking(std::make_shared<AxisCheckProgress>())(), FileError);
  hub_->use("b");
  EXPECT_EQ(hub_->refusal(), "") << "another device";
  write("in_use = \n");
  EXPECT_NE(hub(kPushes).refusal(), "");
  EXPECT_NE(refusal_to_open(), "");
  EXPECT_EQ(hub(kLeadsHand).refusal(), "") << "it has no force";
  EXPECT_EQ(opened, 0);
}

TEST_F(AHub, TakesTheDeviceOnceTheFileIsMended) {
  write("[device.a]\nchecked = 7\n");
  hub(kPushes);
  EXPECT_NE(hub_->refusal(), "");
  EXPECT_NE(hub_->complaint(), "");
  write("[device.a]\nchecked = true\n[device.a.limits]\ntip_force = 1.0\n");
  hub_->read_again();
  EXPECT_EQ(hub_->refusal(), "");
  EXPECT_EQ(hub_->notes("a").limits.tip_force, 1);
  EXPECT_NO_THROW(hub_->opening()());
}

// A device may be in the loop with these limits.
TEST_F(AHub, GoesOnWithTheLimitsThatItHasWhenTheFileBreaks) {
  write("[device.a]\nchecked = true\n[device.a.limits]\ntip_force = 1.0\n");
  DeviceNotes& notes = hub(kPushes).notes("a");
  for (const char* broken : {"[device.a.limits]\ntip_force = \"1\"\n", "in_use = \n", ""}) {
    write(broken);
    hub_->read_again();
    EXPECT_EQ(notes.limits.tip_force, 1) << broken;
  }
}

TEST_F(AHub, TakesInWhatOthersHaveWrittenWhenItSaves) {
  DeviceHub& one = hub(kPushes);
  DeviceHub other(file, {});
  DeviceNotes& notes = one.notes("a");
  notes.checked = true;
  EXPECT_EQ(one.save(), "");
  other.use("b");
  other.read_again();
  other.notes("a").limits.tip_force = 2;
  EXPECT_EQ(other.save(), "");
  notes.pid.effort = 1.5;
  EXPECT_EQ(one.save(), "");
  EXPECT_EQ(notes.limits.tip_force, 2) << "through the reference that was had before";
  EXPECT_EQ(one.in_use(), "a") << "each window has a device of its own";
  const DeviceStore read = load_device_store(file);
  EXPECT_EQ(read.notes.at("a").limits.tip_force, 2);
  EXPECT_EQ(read.notes.at("a").pid.effort, 1.5);
  EXPECT_EQ(read.in_use, "b");
}

DeviceTraits joints(int count, double effort) {
  DeviceTraits traits;
  traits.name = "a device";
  traits.dof = count;
  traits.effort.assign(static_cast<std::size_t>(count), effort);
  return traits;
}

TEST(ArmForADevice, HasAsManyJointsAndPushesNoHarder) {
  const ArmDescription omni = read_urdf(std::string(LIMPID_ASSETS_DIR) + "/devices/omni.urdf");
  const test::TempDir dir;
  DeviceHub hub(dir / "devices.toml", {});
  hub.use("a device");
  hub.say_arm(kBuiltInArm, "", nullptr);
  const ArmDescription same = hub.arm_for(joints(3, 0.01)).arm;
  EXPECT_EQ(same.urdf, omni.urdf);
  for (const Joint& joint : same.joints) EXPECT_EQ(joint.effort, 0.01);
  const ArmDescription strong = hub.arm_for(joints(3, 100)).arm;
  EXPECT_EQ(strong.joints[1].effort, omni.joints[1].effort);
  EXPECT_EQ(hub.arm_for(joints(2, 0.2)).arm.dof(), 2);
  EXPECT_EQ(hub.arm_for(joints(1, 0.2)).arm.dof(), 1);
  EXPECT_THROW(hub.arm_for(joints(5, 1)), FileError);
}

TEST(ArmForADevice, IsRememberedWithTheDeviceThatAnsweredThen) {
  const test::TempDir dir;
  {
    DeviceHub hub(dir / "devices.toml", {});
    hub.use("a device");
    hub.say_arm(kBuiltInArm, "", nullptr);
    EXPECT_TRUE(hub.note_said_arm(joints(3, 1)));
    EXPECT_FALSE(hub.note_said_arm(joints(2, 1))) << "the first that answers is it";
    EXPECT_EQ(hub.save(), "");
  }
  DeviceHub hub(dir / "devices.toml", {});
  EXPECT_TRUE(hub.arm_for(joints(3, 1)).known);
  EXPECT_FALSE(hub.arm_for(joints(2, 1)).known) << "another device under its id";
  hub.say_arm("", "", nullptr);
  EXPECT_FALSE(hub.arm_for(joints(3, 1)).known);
}

TEST(ArmForADevice, IsWhatItWasIdentifiedAsUntilThatIsForgotten) {
  const test::TempDir dir;
  setenv("XDG_DATA_HOME", (dir / "data").c_str(), 1);
  const ArmDescription omni = read_urdf(std::string(LIMPID_ASSETS_DIR) + "/devices/omni.urdf");
  ArmDescription found = omni;
  found.links[1].mass = 0.123;
  const OwnForces taken_off{{.holds_weight = true, .friction_share = 0.6, .holds_springs = true},
                            Down::plus_x};
  {
    DeviceHub hub(dir / "devices.toml", {});
    hub.use("1209:4c50:a/b c");
    EXPECT_EQ(hub.remember({.urdf = urdf_text(found, "found"), .report = "{}", .delay = 0.0021}),
              "");
    hub.notes(hub.in_use()).compensation = taken_off;
    EXPECT_EQ(hub.save(), "");
  }
  DeviceHub hub(dir / "devices.toml", {});
  EXPECT_EQ(hub.arm_for(joints(3, 0.3)).arm.links[1].mass, 0.123);
  EXPECT_EQ(hub.arm_for(joints(3, 0.3)).arm.delay, 0.0021)
      << "its file lacks it, the store does not";
  EXPECT_EQ(hub.notes("1209:4c50:a/b c").compensation, taken_off);
  Parameters given;
  hub.notes("1209:4c50:a/b c").compensation.give(given);
  EXPECT_EQ(given.down, Down::plus_x);
  EXPECT_EQ(OwnForces::of(given), taken_off);
  EXPECT_EQ(hub.notes("1209:4c50:a/b c").delay, 0.0021);
  std::filesystem::remove_all(dir / "data");
  try {
    hub.arm_for(joints(3, 0.3));
    ADD_FAILURE() << "an arm that nobody has measured in its place";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("--forget"), std::string::npos) << error.what();
  }
  hub.forget_arm();
  EXPECT_TRUE(std::isnan(hub.notes("1209:4c50:a/b c").delay));
  EXPECT_EQ(hub.notes("1209:4c50:a/b c").compensation, OwnForces{});
  EXPECT_EQ(hub.arm_for(joints(3, 0.3)).arm.links[1].mass, omni.links[1].mass);
}

// The second result was found with the first correction in place.
TEST(DeviceHub, CorrectsATorqueScaleByWhatIsFoundAgain) {
  const test::TempDir dir;
  setenv("XDG_DATA_HOME", (dir / "data").c_str(), 1);
  DeviceHub hub(dir / "devices.toml", {});
  hub.use("a device");
  const DeviceHub::Profile half{
      .urdf = "<robot/>", .report = "{}", .delay = 0, .torque_scale = 0.5};
  EXPECT_EQ(hub.remember(half), "");
  EXPECT_EQ(hub.notes("a device").torque_scale, 0.5);
  EXPECT_EQ(hub.remember(half), "");
  EXPECT_EQ(hub.notes("a device").torque_scale, 0.25);
  EXPECT_EQ(hub.remember(half), "");
  EXPECT_NE(hub.remember(half), "") << "0.0625 is not believed";
  EXPECT_EQ(hub.notes("a device").torque_scale, 0.125) << "and changes nothing";
}

}  // namespace
}  // namespace limpid
