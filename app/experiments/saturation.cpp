#include <fmt/format.h>
#include "app/experiments/excitation.h"
#include "app/experiments/series.h"
namespace limpid {
namespace {
constexpr const char* kTable = "title='t'\nabout='a'\n[[plane]]\nname='table top'\npoint=[0.2,0.0,-0.04]\nnormal=[0.0,0.0,1.0]\nstiffness=600.0\n";
}
Outcome saturation(Laboratory& lab) {
  std::vector<Trial> ts;
  struct C { double eta, alpha, pull, ratio; };
  std::vector<C> cs;
  for (double eta : {0.6, 1.0, 3.0}) for (double al : {0.035, 0.0035}) for (double pull : {0.15, 0.4}) for (double r : {1e-4,1e-1}) cs.push_back({eta, al, pull, r});
  for (auto& c : cs) for (bool aw : {false, true}) {
    Parameters p; p.eta = c.eta; p.alpha = c.alpha; p.anti_windup = aw; p.torque_limit = 0.2; p.inertia_ratio = c.ratio;
    auto at = [&, pull=c.pull](double t) { double z = 0 + (-0.055) * (minimum_jerk(t / 0.5) - minimum_jerk((t - 1.2) / pull)); return Vec3(0.19, 0, z); };
    ts.push_back({fmt::format("x{}", ts.size()), plan_in(kTable, hand_path("x", 0.001, 2.2, at), p), false});
  }
  auto rs = lab.run(ts);
  for (std::size_t i = 0; i < cs.size(); ++i) {
    fmt::print("eta {} alpha {} pull {} ratio {}\n", cs[i].eta, cs[i].alpha, cs[i].pull, cs[i].ratio);
    for (int w = 0; w < 2; ++w) {
      auto& s = rs[2 * i + static_cast<std::size_t>(w)].session;
      double emax=0, late=0, fpk=0, hold_t=0, hold_e=0, pe=0; 
      for (std::size_t k = 0; k < s.size(); ++k) {
        auto f = vector_at(s,k,Column::hand_torque), e = vector_at(s,k,Column::hand_torque_estimate);
        emax = std::max(emax, e.norm());
        if (k == 1100) { hold_t = f.norm(); hold_e = e.norm(); }
        if (k > 1200) { fpk = std::max(fpk, f.norm()); late=std::max(late,(f-e).norm()); }
        if (k > 100) pe = std::max(pe, coordination_error(s,k).norm());
      }
      auto m = vector_at(s, 1100, Column::motor_torque), c = vector_at(s,1100,Column::commanded_torque), f=vector_at(s,1100,Column::hand_torque), e=vector_at(s,1100,Column::hand_torque_estimate);
      if(!w||1)fmt::print("  aw {} div {} hold true {:.3f} est {:.3f} | rms est hold {:.3f} | pull: peak true {:.3f} err {:.3f} | coord {:.5f}\n", w, rs[2*i+static_cast<std::size_t>(w)].end.diverged, hold_t, hold_e, rms_norm(s, Column::hand_torque_estimate, 700, 1200), fpk, late, pe);
      fmt::print("     mot {:.3f} {:.3f} {:.3f} cmd {:.3f} {:.3f} {:.3f} f {:.3f} {:.3f} {:.3f} e {:.3f} {:.3f} {:.3f}\n", m[0],m[1],m[2],c[0],c[1],c[2],f[0],f[1],f[2],e[0],e[1],e[2]);
    }
  }
  return {};
}
}
