// An experiment as it was carried out, with the recordings that it kept: its figure is compared
// with what these hold.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/experiments/experiment.h"
#include "app/experiments/signals.h"
#include "app/run/replay.h"
#include "tests/support/temp_dir.h"

namespace limpid::test {

// Recording of a trial: its rows, its settings, and the plan that led to it.
struct Kept {
  Session session;
  Parameters p;
  RunPlan plan;

  double time(std::size_t k) const { return static_cast<double>(k) * session.info.tick; }
  std::size_t row(double t) const {
    return static_cast<std::size_t>(std::llround(t / session.info.tick));
  }
  double one(std::size_t k, Column c, std::size_t i = 0) const { return session.at(k, c)[i]; }
  Eigen::VectorXd vec(std::size_t k, Column c) const { return vector_at(session, k, c); }
  double norm(std::size_t k, Column c) const { return vec(k, c).norm(); }
  double error(std::size_t k) const {
    return (vec(k, Column::device_position) - vec(k, Column::proxy_position)).norm();
  }
  Vec3 hand(double t) const { return vec(row(t), Column::hand_target); }
  Vec3 tip(std::size_t k, Column c) const { return tip_at(plan.arm, vec(k, c)); }
  std::size_t size() const { return session.size(); }
  const Object& object(std::size_t i) const { return plan.document.scene.objects.at(i); }
};

class Made {
 public:
  explicit Made(const std::string& name) : name_(name) {
    TrialRunner::Options options;
    options.dir = dir_ / ".";
    TrialRunner lab(name, options);
    outcome_ = std::ranges::find(experiments(), name, &Experiment::name)->run(lab);
    conditions_ = lab.conditions().text();
  }

  const Figure& figure() const { return outcome_.figure; }
  const std::string& conditions() const { return conditions_; }
  const std::vector<Check>& checks() const { return outcome_.checks; }
  // The check of that text; one of its own, that fails, if there is none.
  Check check(const std::string& what) const {
    const auto found = std::ranges::find(outcome_.checks, what, &Check::what);
    EXPECT_NE(found, outcome_.checks.end()) << what;
    return found == outcome_.checks.end() ? Check{} : *found;
  }
  const FigurePanel& panel(const std::string& title) const {
    static const FigurePanel kNone;
    const auto found = std::ranges::find(outcome_.figure.panels, title, &FigurePanel::title);
    EXPECT_NE(found, outcome_.figure.panels.end()) << "no panel \"" << title << '"';
    return found == outcome_.figure.panels.end() ? kNone : *found;
  }
  const Series& curve(const std::string& title, const std::string& label) const {
    static const Series kNone;
    const FigurePanel& shown = panel(title);
    const auto found = std::ranges::find(shown.series, label, &Series::label);
    EXPECT_NE(found, shown.series.end()) << title << ": no curve \"" << label << '"';
    return found == shown.series.end() ? kNone : *found;
  }
  // The n-th of the curves without a label.
  const Series& unnamed(const std::string& title, std::size_t n) const {
    static const Series kNone;
    for (const Series& one : panel(title).series) {
      if (one.label.empty() && n-- == 0) return one;
    }
    ADD_FAILURE() << title << ": too few curves without a label";
    return kNone;
  }
  // `folder`: of trials that experiments share.
  Kept kept(const std::string& trial, const std::string& folder = {}) const {
    const std::filesystem::path file =
        dir_ / "." / (folder.empty() ? name_ : folder) / (trial + ".h5");
    Kept kept{read_session(file), {}, {}};
    kept.p = session_parameters(kept.session, file.string());
    kept.plan = replay(kept.session, file.string(), kept.p);
    return kept;
  }
  // Names of all recordings, in their order.
  std::vector<std::string> trials() const {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(dir_ / "." / name_)) {
      if (entry.path().extension() == ".h5") all.push_back(entry.path().stem().string());
    }
    std::ranges::sort(all);
    return all;
  }

 private:
  test::TempDir dir_;
  std::string name_;
  Outcome outcome_;
  std::string conditions_;
};

// A curve over time shows every n-th row, from the first on to the last.
template <class Value>
void expect_over_time(const Series& curve, const Kept& kept, const Value& value) {
  ASSERT_GE(curve.points.size(), 2u) << curve.label;
  const std::size_t step = kept.row(curve.points[1].x);
  ASSERT_GT(step, 0u) << curve.label;
  EXPECT_EQ(curve.points.size(), (kept.size() + step - 1) / step) << curve.label;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const std::size_t k = i * step;
    ASSERT_LT(k, kept.size()) << curve.label;
    EXPECT_NEAR(curve.points[i].x, kept.time(k), 1e-9) << curve.label;
    const double wanted = value(k);
    ASSERT_NEAR(curve.points[i].y, wanted, 1e-9 * std::max(1.0, std::abs(wanted)))
        << curve.label << " at row " << k;
  }
}

// All points lie on the closed form.
template <class Value>
void expect_on(const Series& curve, const Value& value, double off = 1e-9) {
  EXPECT_FALSE(curve.points.empty()) << curve.label;
  for (const FigurePoint& p : curve.points) {
    EXPECT_NEAR(p.y, value(p.x), off * std::max(1.0, std::abs(value(p.x))))
        << curve.label << " at " << p.x;
  }
}

// The points reach from one x to another one.
inline void expect_from_to(const Series& curve, double from, double to, double off) {
  ASSERT_FALSE(curve.points.empty()) << curve.label;
  EXPECT_NEAR(curve.points.front().x, from, off) << curve.label;
  EXPECT_NEAR(curve.points.back().x, to, off) << curve.label;
}

}  // namespace limpid::test
