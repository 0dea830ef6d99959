// The device that drives the loop: devices found, the one in use, and how it is opened.
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

// Thrown if a device pushes, but its axes have not been checked yet.
struct UncheckedError : HidError {
  using HidError::HidError;
};

class DeviceHub {
 public:
  // `file`: of the store. `ask`: priority for the devices' own threads.
  DeviceHub(std::filesystem::path file, AskForPriority ask);

  // Finds the devices that are plugged in. Reads a few files of the kernel, so not for every frame.
  // `wanted` and `services`: see DeviceSearch.
  static std::vector<FoundDevice> look(const std::string& wanted = {}, bool services = true);
  // Takes the list of devices; without `services` those found before stay.
  void take(std::vector<FoundDevice> found, bool services = true);
  const std::vector<FoundDevice>& found() const { return found_; }

  // Full id of an Inverse3, some of whose words may be missing, or of a device of a maker's
  // library; empty for other devices. Errors: HidError, see inverse_name().
  static std::string id_of(const std::string& words);
  // File of the own arm of such a device.
  static std::filesystem::path arm_file_of(const std::string& id);

  const std::string& in_use() const { return store_.in_use; }  // id; empty: the virtual arm
  // The device in use, if it is plugged in; else null.
  const FoundDevice* present() const;
  // Makes this device the one in use; empty: the virtual arm.
  void use(const std::string& id);
  DeviceNotes& notes(const std::string& id) { return store_.notes[id]; }
  // Why the device in use must not be used: its entry in the store, or the whole store, cannot be
  // understood. Empty: it may be used.
  std::string refusal() const;

  // Makes this window the first one, until give_way(), unless another program's window is. The
  // first window connects to a device by itself, others only when told. Returns the owner for
  // people; empty: this window, or nobody can tell, as opening a device then says why.
  std::string go_first();
  void give_way() { first_ = {}; }

  const AskForPriority& ask() const { return ask_; }

  // Function that connects to the device in use with its axes adjusted, and waits briefly for its
  // first reading; for any thread, at any time. Errors: HidError; UncheckedError if a check is
  // needed first; FileError if the store refuses it.
  std::function<std::unique_ptr<Device>()> opening() const;
  // Opens the device without need of a check, for use without motion.
  std::unique_ptr<Device> open_to_look() const;
  // The arm that the device in use is taken for. `named`, and errors: see taken_arm().
  TakenArm arm_for(const DeviceTraits& traits, const ArmDescription* named = nullptr) const;
  // Takes the device in use for this arm: kBuiltInArm, or a URDF with the tip in it; empty:
  // unknown. Call save() after it. `traits`: of the device, if it is connected.
  void say_arm(const std::string& file, const std::string& tip, const DeviceTraits* traits);
  // Notes that an arm chosen before the device was connected was meant for the device of these
  // traits. True if that was news.
  bool note_said_arm(const DeviceTraits& traits);
  // Whether the device in use is plugged in, and a person may choose its arm, see
  // may_be_told_its_arm().
  bool may_say_arm() const;
  // Whether may_say_arm(), and nobody has.
  bool asks_for_arm() const { return may_say_arm() && known().taken_for.empty(); }
  // Results of an identification.
  struct Profile {
    std::string urdf;         // the arm
    std::string report;       // the findings, as JSON
    double delay = 0;         // [s]
    double torque_scale = 1;  // real over commanded torque, besides the scale in the store
  };
  // Takes the device in use for the identified arm, once it is connected anew; call save() after
  // it. Returns the error; empty: none.
  std::string remember(const Profile& profile);
  // Report of the identification of the device in use; empty: it was not identified.
  std::string remembered_report() const;
  // Forgets the identification, and the forces that motors took off the hand.
  void forget_arm();
  // Whether the device in use is known to push, and its axes have not been checked. For other
  // devices only opening() tells.
  bool needs_check() const;
  // Function that connects to the device and checks its axes as the arm that it is taken for,
  // within its limits; see opening() and run_axis_check().
  std::function<AxisCheck()> checking(const std::shared_ptr<AxisCheckProgress>& progress) const;
  // Writes changes and takes in those of other programs. Returns the error; empty: none.
  std::string save();
  // Takes in the present file.
  void read_again();
  std::string complaint() const { return store_.complaint(); }  // of the store; empty: none

 private:
  DeviceNotes known() const;  // of the device in use
  struct Opening;
  Opening opening_now() const;
  std::optional<FoundDevice> found_now() const;

  std::filesystem::path file_;
  AskForPriority ask_;
  DeviceStore written_;  // as last read or written
  DeviceStore store_;
  std::vector<FoundDevice> found_;
  DeviceClaim first_;
};

}  // namespace limpid
