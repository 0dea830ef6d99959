#include "core/tick/tick.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/coupling/ledger.h"
#include "core/math/subnormals.h"
#include "core/tick/as_taken.h"

namespace limpid {

namespace {

// Least share of a motor's limit that is left to the law, however much the arm weighs.
constexpr double kLeastForLaw = 0.1;

}  // namespace

template <int N>
Tick<N>::Tick(const ArmDescription& arm, const Scene& scene)
    : layout_(arm.dof(), count_bodies(scene)),
      arm_(arm),
      arm_damping_(of_joints<N>(arm, &Joint::damping)),
      arm_limit_(of_joints<N>(arm, &Joint::effort)),
      arm_friction_(of_joints<N>(arm, &Joint::friction)),
      arm_delay_(arm.delay),
      velocity_(arm.dof()),
      observer_(arm.dof()),
      proxy_(arm, scene),
      link_(arm.dof()),
      compensation_(arm),
      motors_(arm.dof()),
      warmth_(arm),
      safety_(arm),
      J_(Jacobian<N>::Zero(3, arm.dof())) {
  start(Parameters{}, Start<N>::at_rest(Vec<N>::Zero(arm.dof())));
}

template <int N>
void Tick<N>::start(const Parameters& p, const Start<N>& start) {
  restart_here(p, start);
  motors_.start();
  restarted_ = false;
  safety_.start();
  gate_.start(start.armed);
  barred_ = unbarred_ = false;
}

template <int N>
void Tick<N>::restart_here(const Parameters& p, const Start<N>& start) {
  const Vec<N> zero = Vec<N>::Zero(start.x1.size());
  proxy_.place(start.x2, start.v2, p.inertia_ratio);
  if (BodyWorld* world = proxy_.contacts().world(); world != nullptr && !world->read(start.world)) {
    world->reset();
  }
  to_bodies_ = pulled_ = 0;
  velocity_.reset(start.x1);
  observer_.reset(start.f1_hat, zero);  // the sampled velocity is zero at k = 0
  compensation_.start(p);
  warmth_.start(start.warmth);
  books_ = {};
  x1_before_ = start.x1;
  f1_hat_ = start.f1_hat;
  tau1_ = vbar2_ = loads_ = zero;
  b_d_ = resolve<N>(p.damping, arm_damping_);
  kind_ = p.kind;
  start_law(
      {start.x1, start.v1, start.f1_hat, start.reserve, start.owed ? Owed::all : Owed::nothing});
  k_ = period_ = 0;
  diverged_ = false;
  restarted_ = true;
}

template <int N>
void Tick<N>::exchange(std::unique_ptr<Contacts<N>>& contacts) {
  proxy_.exchange(contacts);
  motors_.begin_slew();
}

template <int N>
const Vec<N>& Tick<N>::run(const Parameters& given, const Reading<N>& in, ForceRequest wish,
                           std::span<double> row) {
  const NoSubnormals fast_at_rest;
  std::optional<Parameters> of_device;
  if (in.health.guarded) {
    of_device = as_taken(given, {arm_damping_.minCoeff(), arm_limit_.maxCoeff()});
  }
  const Parameters& p = of_device ? *of_device : given;
  const double put_out = k_ > 0 ? tau1_.dot(in.x - x1_before_) : 0;
  if (k_ > 0) warm_up(p, in);
  const bool anew = in.health.gap || unbarred_;
  if (anew) begin_anew(in);
  const int periods = k_ > 0 && !anew ? in.periods : 1;
  const double T = periods * p.tick;
  if (k_ > 0) period_ += static_cast<std::uint64_t>(in.periods);
  if (k_ > 0) close_books(in, T);
  proxy_.set_ratio(p.inertia_ratio);
  if (std::exchange(unbarred_, false)) bring_proxy(in.measured, p);
  b_d_ = resolve<N>(p.damping, arm_damping_);
  limit_ = resolve<N>(p.torque_limit, arm_limit_);
  if (in.health.guarded) limit_ = limit_.cwiseMin(arm_limit_);
  warmth_.report(in.warmth);
  warmth_.limit(limit_);

  // The device, (5), as the controller believes it to be.
  const bool goes_on = k_ > 0 && !anew;
  if (goes_on) velocity_.update(in.measured, T, p.velocity, p.encoder_step);
  if (!goes_on) velocity_.reset(in.measured);
  if (p.kind != kind_) switch_law(p.kind, in.measured);
  const DeviceEstimate<N> at = coupling_.locate(
      p.kind, p, {in.measured, velocity_.estimate(), goes_on ? T : 0, p.encoder_step});
  device_.v = at.v;
  proxy_.catch_up_beside(at.x, at.v, frames_, device_.M, device_.C);
  device_.M *= p.inertia_error;
  device_.C *= p.inertia_error;
  const Vec<N>& v1 = velocity_.raw();

  // Human force, (16)-(18).
  f1_hat_ = goes_on
                ? observer_.estimate(p.alpha, T, device_.M, device_.C, velocity_.estimate(), b_d_)
                : observer_.present();

  // The coupling, (1)-(2), (7)-(15), and with it the proxy, (4).
  x2_ = proxy_.x();
  v2_ = proxy_.v();
  kinetic_ = proxy_.kinetic_energy();
  write_bodies(row);
  proxy_.contacts().want_magnet(in.magnet);
  if (BodyWorld* world = proxy_.contacts().world()) world->pull(in.pull);
  const Vec<N> left = own_forces(p, at, in, T);
  const Vec<N> b_d_sure = in.health.guarded ? Vec<N>(0 * b_d_) : b_d_;
  LawInput<N> now{in.measured,    v1,
                  device_,        f1_hat_,
                  vbar2_,         T,
                  frames_,        b_d_,
                  b_d_sure,       left,
                  gate_.gain(),   p.tick,
                  p.encoder_step, most_delay(p, arm_delay_, in.health.guarded),
                  link_.of(p)};
  now.armed_anew = gate_.armed_anew();
  now.tip_force = tip_force_left(in.health.guarded);
  now.alpha = p.alpha;
  command_ = coupling_.step(p.kind, p, now, proxy_);
  potential_ = proxy_.contact_potential();
  if (k_ == 0) first_potential_ = potential_;
  vbar2_ = proxy_.vbar();

  diverged_ = diverged_ || !(command_ + loads_).allFinite();
  pass_on(p, in, wish, put_out, T);
  // The observer must not take the device's own forces for the hand's, nor the law the motors'
  // torque for them for its own.
  observer_.applied(p.anti_windup ? Vec<N>(tau1_ - loads_) : command_);
  coupling_.applied(p.kind, tau1_ - loads_);
  write_row(p, in, row);
  x1_before_ = in.x;
  ++k_;
  return tau1_;
}

// Sets the motors' torque for the device's own forces, and for the excitation, which to law and
// observer is a push of the hand. Returns the torque that is left to the law.
template <int N>
Vec<N> Tick<N>::own_forces(const Parameters& p, const DeviceEstimate<N>& at, const Reading<N>& in,
                           double T) {
  const bool excited = !in.excitation.isZero(0);
  if (in.health.guarded || excited) {
    arm_.point_jacobian(frames_, arm_.dof() - 1, arm_.tip(frames_), J_);
  }
  const Vec<N> friction = resolve<N>(p.friction, arm_friction_);
  loads_ = compensation_.step(p, arm_, frames_, at.x, at.v, friction, p.encoder_step, T);
  if (excited) loads_ += J_.transpose() * in.excitation;
  return (limit_ - loads_.cwiseAbs()).cwiseMax(kLeastForLaw * limit_);
}

// Lets the motors warm up by the torque that they held since the last tick. After a pause of the
// loop they have held it for a part of the time.
template <int N>
void Tick<N>::warm_up(const Parameters& p, const Reading<N>& in) {
  const double passed = in.dt > 0 ? in.dt : in.periods * p.tick;
  const double held = std::min(passed, std::max(MotorWarmth<N>::kHeld, p.tick));
  warmth_.hold(in.acted ? *in.acted : tau1_, held);
  if (passed > held) warmth_.hold(Vec<N>::Zero(tau1_.size()), passed - held);
}

// Part of the tip's limit that the device's own forces leave to the law [N].
template <int N>
double Tick<N>::tip_force_left(bool guarded) const {
  if (!guarded) return std::numeric_limits<double>::infinity();
  const double most = safety_.tip_force();
  return std::max(kLeastForLaw * most, most - tip_force<N>(loads_, J_));
}

// Begins anew after a time without torque: its motion is unknown, so the device counts as found at
// rest.
template <int N>
void Tick<N>::begin_anew(const Reading<N>& in) {
  velocity_.reset(in.measured);
  f1_hat_.setZero();
  observer_.reset(f1_hat_, f1_hat_);
  compensation_.rest();
  tau1_.setZero();
  loads_.setZero();
  motors_.start();
  start_law({in.measured, f1_hat_, f1_hat_, std::nullopt, Owed::growth});
  x1_before_ = in.x;
}

// Brings the proxy to the device, which may have gone anywhere while it had no force: the proxy
// must pull on nothing when force returns.
template <int N>
void Tick<N>::bring_proxy(const Vec<N>& x, const Parameters& p) {
  proxy_.catch_up();
  proxy_.look(p.tick);
  first_potential_ -= proxy_.contact_potential();
  vbar2_.setZero();
  proxy_.place(x, vbar2_, p.inertia_ratio);
  first_potential_ += proxy_.contact_potential();
}

template <int N>
void Tick<N>::start_law(const LawStart<N>& at) {
  link_.start();
  coupling_.start(at);
}

// Starts another law from the present state; the torque changes at a bounded rate.
template <int N>
void Tick<N>::switch_law(CouplingKind to, const Vec<N>& x1) {
  motors_.begin_slew();
  proxy_.contacts().forget();
  start_law({x1, velocity_.estimate(), f1_hat_, std::nullopt, Owed::nothing, true});
  kind_ = to;
}

// Takes the command to the motors.
template <int N>
void Tick<N>::pass_on(const Parameters& p, const Reading<N>& in, ForceRequest wish, double put_out,
                      double T) {
  // The time that really passed; the estimate reckons with whole ticks.
  const double passed = in.dt > 0 && !in.health.gap ? in.dt : T;
  const Vec<N> v = T / passed * velocity_.estimate();
  const Objections against =
      safety_.judge(in.health, diverged_, {in.measured, v, J_, tau1_, put_out, passed});
  const double dt = in.dt > 0 ? std::min(in.dt, p.tick) : p.tick;
  gate_.step(wish, against, dt);
  const bool barred = against.fault != ForceState::on || !(against.ceiling > 0);
  unbarred_ = std::exchange(barred_, barred) && !barred && in.health.guarded;
  const bool limited = in.health.guarded && !diverged_;
  // Nothing is left to give: torque on its way from one law to another must not go on giving.
  if (!(coupling_.report(p.kind).torque_governor > 0)) motors_.end_slew();
  // A restart asks for another torque than a tick ago. Rows of a virtual arm follow from where they
  // begin, so there the earlier torque does not count.
  if (std::exchange(restarted_, false) && limited) motors_.begin_slew();
  const Vec<N> all = command_ + loads_;
  const TorqueLimits<N> most =
      limited ? TorqueLimits<N>(limit_, J_, safety_.tip_force()) : TorqueLimits<N>(limit_);
  const double gain = unbarred_ ? 0 : gate_.gain();
  tau1_ = motors_.pass(all, most, gain, dt, limited ? SafetyLimits::kSlew : 0);
}

template <int N>
void Tick<N>::close_books(const Reading<N>& in, double T) {
  const Vec<N> dx1 = in.x - x1_before_;
  const Vec<N> dx2 = proxy_.x() - x2_;
  books_.add(in.acted ? *in.acted : tau1_, dx1, proxy_.tau(), dx2, b_d_, T);
  books_.compensation += gate_.gain() * loads_.dot(dx1);
  books_.add_contact(proxy_.f(), dx2);
}

template <int N>
void Tick<N>::write_row(const Parameters& p, const Reading<N>& in, std::span<double> row) const {
  const auto put = [&](Column c, const Vec<N>& values) {
    std::copy_n(values.data(), values.size(), layout_.in(row, c).begin());
  };
  const auto set = [&](Column c, double value) { layout_.in(row, c)[0] = value; };
  set(Column::time, static_cast<double>(period_) * p.tick);
  put(Column::device_position, in.x);
  put(Column::device_velocity, in.v);
  put(Column::measured_position, in.measured);
  put(Column::measured_velocity, velocity_.estimate());
  put(Column::commanded_torque, command_);
  put(Column::motor_torque, tau1_);
  put(Column::proxy_position, x2_);
  put(Column::proxy_velocity, v2_);
  put(Column::proxy_torque, proxy_.tau());
  put(Column::contact_torque, proxy_.f());
  put(Column::hand_torque_estimate, f1_hat_);
  put(Column::compensation_torque, loads_);
  put(Column::motor_warmth, warmth_.known());
  std::copy_n(in.excitation.data(), 3, layout_.in(row, Column::excitation).begin());
  set(Column::force_wanted, gate_.armed() ? 1 : 0);
  set(Column::force_state, static_cast<double>(gate_.why()));
  set(Column::kind, static_cast<double>(p.kind));
  set(Column::eta, p.eta);
  set(Column::alpha, p.alpha);
  const LawReport law = coupling_.report(p.kind);
  set(Column::governor, law.contact_governor);
  set(Column::damping_governor, law.damping_governor);
  set(Column::torque_governor, law.torque_governor);
  const TickSolve solved = proxy_.stood_still() ? TickSolve::stood_still : law.solved;
  set(Column::solved, static_cast<double>(solved));
  set(Column::unsettled, static_cast<double>(law.unsettled + proxy_.unsettled()));
  const double reserve = coupling_.reserve();
  set(Column::energy_ledger, std::isfinite(reserve) ? reserve : 0);
  set(Column::energy_port, books_.port);
  set(Column::energy_total, books_.total);
  set(Column::energy_commanded, books_.commanded);
  set(Column::energy_compensation, books_.compensation);
  set(Column::proxy_kinetic, kinetic_);
  set(Column::contact_potential, potential_);
  set(Column::contact_gain, books_.contact_gain(potential_, first_potential_, to_bodies_));
  write_contacts(row);
  if (const BodyWorld* world = proxy_.contacts().world()) {
    set(Column::energy_objects, world->energy());
    set(Column::objects_gain, world->gain());
    set(Column::objects_awake, world->awake());
    set(Column::objects_sweeps, world->sweeps());
    set(Column::objects_left_out, world->left_out());
    set(Column::objects_stood_still, world->stood_still());
    set(Column::objects_turned_less, world->turned_less());
    const auto& magnet = proxy_.contacts().magnet();
    set(Column::magnet, magnet.on() ? magnet.body + 1 : 0);
    set(Column::hand_magnet, in.magnet ? 1 : 0);
    set(Column::hand_pull, in.pull.body + 1);
    std::copy_n(in.pull.point.data(), 3, layout_.in(row, Column::pull_point).begin());
    std::copy_n(in.pull.target.data(), 3, layout_.in(row, Column::pull_target).begin());
    set(Column::energy_pulled, pulled_);
  }
}

// Writes the bodies now: the law will have moved them when the rest of the row is written.
template <int N>
void Tick<N>::write_bodies(std::span<double> row) {
  const BodyWorld* world = proxy_.contacts().world();
  if (world == nullptr) return;
  auto pose = layout_.in(row, Column::body_pose).begin();
  auto velocity = layout_.in(row, Column::body_velocity).begin();
  for (int i = 0; i < world->count(); ++i) {
    const Eigen::Quaterniond turned(world->pose(i).linear());
    pose = std::copy_n(world->center(i).data(), 3, pose);
    for (const double part : {turned.w(), turned.x(), turned.y(), turned.z()}) *pose++ = part;
    velocity = std::copy_n(world->speed(i).data(), 3, velocity);
    velocity = std::copy_n(world->spin(i).data(), 3, velocity);
  }
  to_bodies_ = world->all_given();
  pulled_ = world->all_pulled();
  layout_.in(row, Column::energy_to_objects)[0] = to_bodies_;
}

template <int N>
void Tick<N>::write_contacts(std::span<double> row) const {
  std::array<ContactForce, kRowContacts> hardest{};
  proxy_.contacts().forces(hardest);
  auto point = layout_.in(row, Column::contact_point).begin();
  auto force = layout_.in(row, Column::contact_force).begin();
  for (const ContactForce& contact : hardest) {
    point = std::copy_n(contact.point.data(), 3, point);
    force = std::copy_n(contact.force.data(), 3, force);
  }
}

template class Tick<3>;
template class Tick<7>;
template class Tick<kAnyDof>;

}  // namespace limpid
