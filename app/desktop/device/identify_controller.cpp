#include "app/desktop/device/identify_controller.h"

#include <fmt/format.h>

#include <utility>

#include "app/base/dated_file.h"
#include "app/base/folders.h"
#include "app/experiments/identify_report.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kSeed = 1;  // of the simulated device

fs::path folder_for(const std::string& name) {
  return dated_file(user_data_dir() / "identified", as_file_name(name));
}

// Keeps the recorded motion, even if nothing can be concluded from it.
IdentifyController::Done conclude(const std::string& name, const IdentifyRequest& order,
                                  IdentifyRun bare, IdentifyRun with_load,
                                  const std::string& last) {
  const fs::path folder = folder_for(name);
  write_motion(bare, folder / kMotionFile);
  if (order.load > 0) write_motion(with_load, folder / kLoadedMotionFile);
  IdentifyController::Done done{
      .identification = identification(name, order, std::move(bare), std::move(with_load)),
      .drift = {},
      .report = folder,
      .no_pictures = {}};
  const std::optional<Findings> before = read_findings(last);
  if (before) done.drift = drift(*before, done.identification);
  done.no_pictures = write_identification(done.identification, before, folder);
  return done;
}

}  // namespace

std::string IdentifyController::why_not() const {
  if (live_.recording()) return "Stop the recording first.";
  if (simulated()) return {};
  if (live_.loop().device_plugged() && !live_.loop().device_in_place()) {
    return "The device has no motors that could move it.";
  }
  if (!live_.loop().device_plugged()) {
    return devices_.problem().empty() ? "The device is not part of the control loop."
                                      : devices_.problem();
  }
  return {};
}

double IdentifyController::duration(const ExcitationPlan& plan) const {
  const ArmDescription& arm = live_.stage().arm();
  DeviceTraits traits;
  traits.dof = arm.dof();
  for (const Joint& joint : arm.joints) traits.effort.push_back(joint.effort);
  traits.pushes = true;
  return Excitation(arm, traits, plan).duration();
}

void IdentifyController::begin(IdentifyRequest order) {
  if (phase_ != Phase::asking || !why_not().empty()) return;
  request_ = std::move(order);
  request_.guess = live_.stage().arm();
  id_ = devices_.hub().in_use();
  if (simulated()) {
    request_.seed = kSeed;
    bench_ = simulated_bench(request_, kSeed);
    name_ = bench_.name;
  } else {
    const FoundDevice* found = devices_.hub().present();
    name_ = found != nullptr ? found->place.name : id_;
    request_.plan = within(request_.plan, devices_.hub().notes(id_).limits);
    devices_.lend();
  }
  bare_.reset();
  done_.reset();
  wrong_.clear();
  phase_ = Phase::moving;
}

// Starts the motion. The loop must have given the device back: nobody else may drive it.
void IdentifyController::move() {
  progress_ = std::make_shared<IdentifyProgress>();
  const auto run = [order = request_, with_load = bare_.has_value(), progress = progress_,
                    bench = bench_, open = simulated() ? nullptr : devices_.hub().opening(),
                    ask = devices_.hub().ask(), warmth = live_.loop().warmth_memory()] {
    if (!open) return move_simulated(bench, order, with_load, *progress);
    const std::unique_ptr<Device> device = open();
    progress->see();
    IdentifyRun done = run_identification(*device, order.guess, order.plan, *progress, ask);
    warmth->add(done.warmth, in_seconds(MonotonicTime{}.now()));
    return done;
  };
  moving_ = live_.device_tasks().run(run);
}

void IdentifyController::go_on() {
  if (phase_ == Phase::load) phase_ = Phase::moving;
}

void IdentifyController::update() {
  progress_->see();
  if (phase_ != Phase::asking && devices_.hub().in_use() != id_) stop();
  try {
    follow_motion();
    follow_work();
  } catch (const std::exception& e) {
    fail(e.what());
  }
}

void IdentifyController::follow_motion() {
  if (phase_ != Phase::moving) return;
  if (!moving_.valid()) {
    if (simulated() || !live_.loop().holds_device()) move();
    return;
  }
  std::optional<IdentifyRun> run = take_ready(moving_);
  if (!run) return;
  if (run->end != ExcitationEnd::complete) return fail(explain(*run, request_));
  if (request_.load > 0 && !bare_) {
    bare_ = std::move(run);
    phase_ = Phase::load;
    return;
  }
  IdentifyRun with_load;
  if (bare_) with_load = std::move(*run);
  phase_ = Phase::working;
  working_ = live_.device_tasks().run(
      [name = name_, order = request_, bare = bare_ ? std::move(*bare_) : std::move(*run),
       with_load = std::move(with_load), last = devices_.hub().remembered_report()]() mutable {
        return conclude(name, order, std::move(bare), std::move(with_load), last);
      });
}

void IdentifyController::follow_work() {
  if (phase_ != Phase::working) return;
  if (auto done = take_ready(working_)) {
    done_ = std::move(*done);
    phase_ = Phase::found;
    if (std::exchange(left_, false)) {
      notices_.say(fmt::format("{} is identified. F7 shows the values found.", name_));
    }
  }
}

void IdentifyController::fail(const std::string& why) {
  stop();
  wrong_ = why;
}

void IdentifyController::stop() {
  progress_->cancel = true;
  if (phase_ == Phase::asking) return;
  wrong_ = busy() ? "stopped" : "";
  left_ = false;
  phase_ = Phase::asking;
  moving_ = {};
  working_ = {};
  done_.reset();
  devices_.take_back();
}

void IdentifyController::leave() {
  if (moving()) return stop();
  left_ = phase_ == Phase::working;
  devices_.take_back();
}

void IdentifyController::keep() {
  if (phase_ != Phase::found || simulated()) return;
  const std::string wrong = devices_.hub().remember(profile_of(done_->identification));
  if (!wrong.empty()) return fail(wrong);
  stop();
  devices_.connect_anew();  // the loop may still have it with the values of before
  notices_.say("Remembered: " + name_ +
               " has the values found by this identification from now on.");
}

}  // namespace limpid
