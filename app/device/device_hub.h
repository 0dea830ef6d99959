// Which device drives the loop: what is plugged in, the one in use, and getting it back.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/device/axis_check_run.h"
#include "app/device/device_store.h"
#include "app/device/taken_arm.h"
#include "devices/hid/device_list.h"
#include "devices/hid/hid_transport.h"

namespace limpid {

// It pushes, and nobody has seen yet that its motors move its axes as they are told.
struct UncheckedError : HidError {
  using HidError::HidError;
};

class DeviceHub {
 public:
  // `file`: of the store. `ask`: for the devices' own threads.
  DeviceHub(std::filesystem::path file, AskForPriority ask);

  // What is plugged in. Reads a few files of the kernel's: not for every frame. `wanted` and
  // `services`: see DeviceSearch.
  static std::vector<FoundDevice> look(const std::string& wanted = {}, bool services = true);
  // Without services, those of before stay.
  void take(std::vector<FoundDevice> found, bool services = true);
  const std::vector<FoundDevice>& found() const { return found_; }

  // Of an Inverse3, which has an id with words left out: the whole of it; of others nothing. Throws
  // HidError, see inverse_name().
  static std::string id_of(const std::string& words);

  const std::string& in_use() const { return store_.in_use; }  // id; empty: the virtual arm
  // What is plugged in of it; null: nothing.
  const FoundDevice* present() const;
  // From now on this one; empty: the virtual arm.
  void use(const std::string& id);
  DeviceNotes& notes(const std::string& id) { return store_.notes[id]; }
  // Why the device in use is not used for what its store says, or fails to say: an entry, or the
  // whole file, that cannot be understood. Empty: it may be.
  std::string refusal() const;

  // The first window that has a device connects to it by itself, any other one when it is told to.
  // Makes this the first one, until give_way(), unless another program's window is. Returns who has
  // it then, for people; empty: this one is.
  std::string go_first();
  void give_way() { first_ = {}; }

  const AskForPriority& ask() const { return ask_; }

  // Connects to the device in use, its axes adjusted, and waits a moment for its first reading. May
  // be called from anywhere, later. Errors: HidError; UncheckedError where it has to be checked
  // first; FileError where its store refuses it.
  std::function<std::unique_ptr<Device>()> opening() const;
  // The same without the check: for what moves nothing.
  std::unique_ptr<Device> open_to_look() const;
  // The arm that the device in use is taken for; `named`, and errors: see taken_arm().
  TakenArm arm_for(const DeviceTraits& traits, const ArmDescription* named = nullptr) const;
  // From now on, once saved, the device in use is taken for this arm: kBuiltInArm, or a URDF with
  // the tip in it; empty: nobody has said. `traits`: of the device, where it is connected.
  void say_arm(const std::string& file, const std::string& tip, const DeviceTraits* traits);
  // The device of these traits is what was meant when somebody said it before it was connected.
  // True if that was news.
  bool note_said_arm(const DeviceTraits& traits);
  // The device in use is there, and somebody may say which arm it is; nobody has.
  bool may_say_arm() const;
  bool asks_for_arm() const { return may_say_arm() && known().taken_for.empty(); }
  // What a device was found to be.
  struct Profile {
    std::string urdf;         // the arm
    std::string report;       // the findings, as JSON
    double delay = 0;         // [s]
    double torque_scale = 1;  // what its motors give of what they were told meanwhile
  };
  // From now on the device in use is that, connected anew; once saved. Returns what went wrong,
  // empty if nothing did.
  std::string remember(const Profile& profile);
  // The report of what the device in use was found to be; empty: nobody knows.
  std::string remembered_report() const;
  // Takes it for its file's again, and nothing of its forces off the hand.
  void forget_arm();
  // It is known to push, and its axes were not checked yet: it may not. Of others only opening()
  // tells.
  bool needs_check() const;
  // Connects to it and checks its axes, as opening() and run_axis_check(), within the limits that
  // are set for it, as the arm that it is taken for.
  std::function<AxisCheck()> checking(const std::shared_ptr<AxisCheckProgress>& progress) const;
  // Writes what was changed here and takes in what other programs have changed. Returns what went
  // wrong, empty if nothing did.
  std::string save();
  // Takes in what the file says by now.
  void read_again();
  std::string complaint() const { return store_.complaint(); }  // about the store; empty: none

 private:
  DeviceNotes known() const;  // of the device in use
  struct Opening;
  Opening opening_now() const;
  std::optional<FoundDevice> found_now() const;

  std::filesystem::path file_;
  AskForPriority ask_;
  DeviceStore written_;  // as it was last read or written
  DeviceStore store_;
  std::vector<FoundDevice> found_;
  DeviceClaim first_;
};

}  // namespace limpid
