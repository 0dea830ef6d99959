#include "app/device/device_hub.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <iterator>
#include <optional>

#include "app/base/folders.h"
#include "devices/files/atomic_file.h"
#include "devices/files/text_file.h"
#include "devices/hid/device_list.h"
#include "devices/hid/hid_transport.h"
#include "devices/hid/vendor_devices.h"

namespace limpid {
namespace {

constexpr std::chrono::milliseconds kFirstReading{200};

// The Inverse3 that an id of the store names, where anything may stand.
std::optional<InverseName> inverse_name_in(const std::string& id) {
  try {
    return inverse_name(id);
  } catch (const HidError&) {
    return std::nullopt;
  }
}

const FoundDevice& usable(const std::optional<FoundDevice>& found, const std::string& id) {
  if (!found) throw HidError(fmt::format("{} is not connected", id));
  if (!found->missing.empty()) {
    throw HidError(fmt::format("{}: {}", found->place.name, found->missing));
  }
  return *found;
}

std::filesystem::path nature_file(const std::string& id, const char* extension) {
  return user_data_dir() / "devices" / (as_file_name(id) + extension);
}

}  // namespace

TakenArm DeviceHub::arm_for(const DeviceTraits& traits, const ArmDescription* named) const {
  const FoundDevice* device = present();
  return taken_arm(known(), device == nullptr ? nullptr : device->kind, traits, named);
}

void DeviceHub::say_arm(const std::string& file, const std::string& tip,
                        const DeviceTraits* traits) {
  DeviceNotes& notes = DeviceHub::notes(store_.in_use);
  notes.taken_for = file;
  notes.taken_for_tip = tip;
  notes.taken_as = file.empty() || traits == nullptr ? "" : what_it_is(traits->name, traits->dof);
}

bool DeviceHub::note_said_arm(const DeviceTraits& traits) {
  DeviceNotes& notes = DeviceHub::notes(store_.in_use);
  if (notes.taken_for.empty() || !notes.taken_as.empty()) return false;
  notes.taken_as = what_it_is(traits.name, traits.dof);
  return true;
}

bool DeviceHub::may_say_arm() const {
  const FoundDevice* device = present();
  return device != nullptr && may_be_told_its_arm(known(), *device->kind);
}

DeviceHub::DeviceHub(std::filesystem::path file, AskForPriority ask)
    : file_(std::move(file)),
      ask_(std::move(ask)),
      written_(load_device_store(file_)),
      store_(written_) {}

std::string DeviceHub::go_first() {
  try {
    if (!first_.held()) first_ = DeviceClaim("first window");
    return {};
  } catch (const ClaimTaken& error) {
    return error.what();
  } catch (const HidError&) {
    return {};
  }
}

std::string DeviceHub::save() {
  if (std::string wrong = save_device_store(written_, store_, file_); !wrong.empty()) return wrong;
  written_.in_use = store_.in_use;
  read_again();
  return {};
}

// Changes notes in place, as others refer to them. Entries that cannot be understood leave them
// unchanged: a device may be in the loop with these limits. The device in use here stays.
void DeviceHub::read_again() {
  const DeviceStore now = load_device_store(file_);
  store_.refusal = now.refusal;
  if (!now.refusal.empty()) return;
  for (auto& [id, notes] : store_.notes) {
    if (!now.notes.contains(id) && id != store_.in_use) notes = {};
  }
  for (const auto& [id, notes] : now.notes) {
    DeviceNotes& known = store_.notes[id];
    if (notes.refusal.empty()) known = notes;
    known.refusal = notes.refusal;
  }
  const std::string in_use = written_.in_use;
  written_ = now;
  written_.in_use = in_use;
}

std::vector<FoundDevice> DeviceHub::look(const std::string& wanted, bool services) {
  return list_devices({data_dir() / "assets/udev/70-limpid.rules", wanted, services});
}

void DeviceHub::take(std::vector<FoundDevice> found, bool services) {
  for (const FoundDevice& before : found_) {
    if (!services && before.kind->service) found.push_back(before);
  }
  found_ = std::move(found);
  // The first device of a service, once found, is the one in use from now on.
  const auto wanted = inverse_name_in(store_.in_use);
  if (!wanted || !wanted->id.empty()) return;
  for (const FoundDevice& each : found_) {
    const auto name = inverse_name_in(each.place.id);
    if (!name || name->id.empty() || name->address != wanted->address) continue;
    return use(each.place.id);
  }
}

std::string DeviceHub::id_of(const std::string& words) {
  if (vendor_kind(words) != nullptr) return words;
  const auto name = inverse_name(words);
  return name ? name->text() : std::string();
}

std::filesystem::path DeviceHub::arm_file_of(const std::string& id) {
  const DeviceKind* const kind = vendor_kind(id);
  return data_dir() / "assets/devices" / (kind != nullptr ? kind->arm : "inverse3.urdf");
}

const FoundDevice* DeviceHub::present() const {
  const auto same = [&](const FoundDevice& each) { return each.place.id == store_.in_use; };
  const auto device = std::ranges::find_if(found_, same);
  return device == found_.end() ? nullptr : &*device;
}

void DeviceHub::use(const std::string& id) { store_.in_use = id; }

DeviceNotes DeviceHub::known() const {
  const auto notes = store_.notes.find(store_.in_use);
  return notes == store_.notes.end() ? DeviceNotes{} : notes->second;
}

std::optional<FoundDevice> DeviceHub::found_now() const {
  const FoundDevice* device = present();
  return device == nullptr ? std::nullopt : std::optional(*device);
}

std::string DeviceHub::refusal() const {
  const FoundDevice* device = present();
  const bool pushes = device == nullptr || !device->kind->leads_hand;
  return pushes && !store_.refusal.empty() ? store_.refusal : known().refusal;
}

// All that opening needs, whatever the hub does meanwhile.
struct DeviceHub::Opening {
  std::string id, refusal;
  std::optional<FoundDevice> found;
  DeviceNotes notes;
  AskForPriority ask;

  std::unique_ptr<Device> open() const {
    if (!refusal.empty()) throw FileError(refusal);
    std::unique_ptr<Device> opened = std::make_unique<AdjustedDevice>(
        open_device(usable(found, id), notes.pid, ask), notes.axes, notes.torque_scale);
    await_reading(*opened, kFirstReading);
    return opened;
  }
};

DeviceHub::Opening DeviceHub::opening_now() const {
  return {store_.in_use, refusal(), found_now(), known(), ask_};
}

std::unique_ptr<Device> DeviceHub::open_to_look() const { return opening_now().open(); }

std::function<std::unique_ptr<Device>()> DeviceHub::opening() const {
  return [opening = opening_now()] {
    std::unique_ptr<Device> opened = opening.open();
    const DeviceTraits& traits = opened->traits();
    if (!traits.pushes || !traits.guarded) return opened;
    const DeviceNotes& notes = opening.notes;
    if (!notes.checked) {
      throw UncheckedError(
          fmt::format("{}: the axes must be checked before the device may push", traits.name));
    }
    const std::string now = what_it_is(traits.name, traits.dof);
    if (!notes.checked_as.empty() && notes.checked_as != now) {
      throw UncheckedError(
          fmt::format("{}: the axes must be checked before the device may push; the check stored "
                      "under this id was made for another device: {}",
                      now, notes.checked_as));
    }
    return opened;
  };
}

std::string DeviceHub::remember(const Profile& profile) {
  DeviceNotes& notes = DeviceHub::notes(store_.in_use);
  const double scale = notes.torque_scale * profile.torque_scale;
  if (scale < kLeastTorqueScale || scale > kMostTorqueScale) {
    return fmt::format("the motors would give {:.3g} times the commanded torque; allowed: {} to {}",
                       scale, kLeastTorqueScale, kMostTorqueScale);
  }
  const std::filesystem::path arm = nature_file(store_.in_use, ".urdf");
  for (const auto& [file, text] :
       {std::pair(arm, &profile.urdf),
        std::pair(nature_file(store_.in_use, ".json"), &profile.report)}) {
    if (std::string wrong = try_write_atomically(file, *text); !wrong.empty()) return wrong;
  }
  notes.arm = arm.string();
  notes.delay = profile.delay;
  notes.torque_scale = scale;
  return {};
}

std::string DeviceHub::remembered_report() const {
  if (known().arm.empty()) return {};
  std::ifstream file(nature_file(store_.in_use, ".json"));
  return {std::istreambuf_iterator<char>(file), {}};
}

void DeviceHub::forget_arm() {
  notes(store_.in_use).arm.clear();
  notes(store_.in_use).delay = DeviceNotes{}.delay;
  notes(store_.in_use).torque_scale = 1;
  notes(store_.in_use).compensation = {};
}

bool DeviceHub::needs_check() const {
  const FoundDevice* device = present();
  return device != nullptr && device->kind->pushes && !known().checked;
}

std::function<AxisCheck()> DeviceHub::checking(
    const std::shared_ptr<AxisCheckProgress>& progress) const {
  return [opening = opening_now(), progress] {
    const std::unique_ptr<Device> device = opening.open();
    const DeviceKind* kind = opening.found ? opening.found->kind : nullptr;
    const TakenArm taken = taken_arm(opening.notes, kind, device->traits());
    return run_axis_check(*device, taken.arm, opening.notes.limits, *progress, opening.ask);
  };
}

}  // namespace limpid
