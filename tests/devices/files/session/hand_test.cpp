#include <math.h>  // Boost's header below needs it

#include <boost/math/interpolators/pchip.hpp>
#include <cmath>

#include "devices/files/session/hand_file.h"
#include "tests/devices/files/test_files.h"

namespace limpid {
namespace {

using test::refusal;
using testing::HasSubstr;

HandPath parse(const std::string& text) { return parse_hand_csv(text, "x.csv"); }

TEST(Hand, TakesMoreColumnsCarriageReturnsSpacesAndBlankLinesAtTheEnd) {
  const HandPath path = parse(
      "time_s, x_m,y_m,z_m,force_N\r\n1,0.1,0.2,0.3,9\r\n"
      "2, 0.2 ,1e-1,-0.3,nan\r\n\r\n\n");
  ASSERT_EQ(path.time, (std::vector<double>{0, 1}));
  EXPECT_EQ(path.position[1], Vec3(0.2, 0.1, -0.3));
  EXPECT_EQ(path.grip, (std::vector<double>{1, 1}));
  EXPECT_EQ(path.duration(), 1);
}

TEST(Hand, TakesAByteOrderMark) {
  const test::TempDir dir;
  test::write_file(dir / "a.csv", "\xEF\xBB\xBFtime_s,x_m,y_m,z_m\n0,0,0,0\n1,0,0,0\n");
  EXPECT_EQ(read_hand(dir / "a.csv").time.size(), 2u);
}

TEST(Hand, HasTheSourceThatALineBeforeTheHeaderSays) {
  const std::string rows = "time_s,x_m,y_m,z_m\n0,0,0,0\n1,0,0,0\n";
  EXPECT_EQ(parse(rows).source, "x.csv");
  EXPECT_EQ(parse("# source: 2 rows from Python\r\n" + rows).source, "2 rows from Python");
  EXPECT_EQ(parse("# source: " + std::string(1000, 'a') + "\n" + rows).source.size(), 200u);
  EXPECT_EQ(parse("# source: a\tb\x1b\n" + rows).source, "a?b?");
  EXPECT_THROW(parse(rows + "# source: late\n"), FileError);
}

TEST(Hand, RefusesWithFileAndLine) {
  const std::string head = "time_s,x_m,y_m,z_m\n";
  struct Case {
    std::string text;
    const char* said;
  };
  const Case cases[] = {
      {"", "x.csv: 0 samples"},
      {"0,0,0,0\n1,0,0,0\n", "x.csv:1: header"},
      {"t,x,y,z\n0,0,0,0\n", "x.csv:1: header"},
      {"time_s,x_m,z_m,y_m\n0,0,0,0\n", "x.csv:1: header"},
      {head, "0 samples"},
      {head + "0,0,0,0\n", "1 samples"},
      {head + "0,0,0,0\n1,0,0\n", "x.csv:3: z_m"},
      {head + "0,0,0,0\n1,0,zero,0\n", "x.csv:3: y_m: \"zero\""},
      {head + "0,0,0,0\n1,0,1.5x,0\n", "x.csv:3: y_m: \"1.5x\""},
      {head + "0,0,0,0\n1,,0,0\n", "x.csv:3: x_m"},
      {head + "0,0,0,0\n\n1,nan,0,0\n", "x.csv:4: x_m: nan"},
      {head + "0,0,0,0\n1,0,inf,0\n", "x.csv:3: y_m: inf"},
      {head + "0,0,0,0\n1,0,0,1e999\n", "x.csv:3: z_m"},
      {head + "0,0,0,0\n1,0,0,10.5\n", "x.csv:3: z_m: 10.5"},
      {head + "0,0,0,0\nnan,0,0,0\n", "x.csv:3: time_s: nan"},
      {head + "0,0,0,0\n0,0,0,0\n", "x.csv:3: time_s: 0 after 0"},
      {head + "1,0,0,0\n0.5,0,0,0\n", "x.csv:3: time_s: 0.5 after 1"},
      {std::string(100000, 'x'), "x.csv:1: header"},
      {std::string("time_s,x_m,y_m,z_m\n0,0,0,0\n\0\n", 29), "x.csv:3:"},
  };
  for (const Case& c : cases) {
    EXPECT_THAT(refusal([&] { parse(c.text); }), HasSubstr(c.said)) << c.text.substr(0, 80);
  }
  EXPECT_THAT(refusal([] { read_hand("/nowhere.csv"); }), HasSubstr("/nowhere.csv"));
}

TEST(Hand, IsAMonotoneCubicAsBoostHasIt) {
  std::string text = "time_s,x_m,y_m,z_m\n";
  std::vector<double> time;
  std::vector<double> x;
  for (int i = 0; i < 40; ++i) {
    time.push_back(0.01 * i + 0.003 * std::sin(i));
    x.push_back(std::sin(0.7 * i) + 0.1 * std::cos(3.1 * i));
    text += std::to_string(time.back()) + "," + std::to_string(x.back()) + ",0,0\n";
  }
  const HandPath path = parse(text);
  std::vector<double> t0 = path.time;
  std::vector<double> x0;
  for (const Vec3& p : path.position) x0.push_back(p.x());
  const boost::math::interpolators::pchip<std::vector<double>> oracle(std::move(t0), std::move(x0),
                                                                      0.0, 0.0);
  for (double t = 0; t < path.duration(); t += 1e-4) {
    ASSERT_NEAR(path.at(t).x(), oracle(t), 1e-12) << t;
  }
}

TEST(Hand, HitsItsSamplesExactlyAndRestsOutside) {
  const HandPath path = parse("time_s,x_m,y_m,z_m\n0,0.1,0.2,0.3\n0.3,0.2,0.1,0.3\n0.7,0.4,0,0\n");
  for (std::size_t i = 0; i < path.time.size(); ++i) {
    EXPECT_EQ(path.at(path.time[i]), path.position[i]);
  }
  EXPECT_EQ(path.at(-5), path.position.front());
  EXPECT_EQ(path.at(5), path.position.back());
  EXPECT_EQ(path.at(std::nan("")), path.position.front());
}

TEST(Hand, HasAContinuousVelocityEverywhere) {
  const HandPath path =
      parse("time_s,x_m,y_m,z_m\n0,0.1,0,0\n0.3,0.2,0,0\n0.7,0.4,0,0\n0.8,0.3,0,0\n");
  const double h = 1e-6;
  const auto speed = [&](double t) { return (path.at(t + h) - path.at(t)).x() / h; };
  for (const double t : path.time) EXPECT_NEAR(speed(t - h), speed(t), 1e-3) << t;
}

TEST(Hand, WithTwoSamplesStartsAndEndsAtRest) {
  const HandPath path = parse("time_s,x_m,y_m,z_m\n0,0,0,0\n1,1,1,1\n");
  EXPECT_NEAR(path.at(0.25).x(), 0.25 * 0.25 * (3 - 2 * 0.25), 1e-15);
}

TEST(Hand, ReadsPeoplesRecordings) {
  const auto folder = test::shared_hands();
  if (folder.empty()) GTEST_SKIP() << "no recordings of people on this computer";
  for (const char* name : {"handwriting_1.csv", "wiping_1.csv", "wiping_2.csv"}) {
    const HandPath path = read_hand(folder / name);
    EXPECT_GT(path.time.size(), 1000u) << name;
    EXPECT_GT(path.duration(), 10) << name;
    EXPECT_LT(path.duration(), 15) << name;
    for (const Vec3& p : path.position) EXPECT_LT(p.norm(), 0.27) << name;
  }
}

}  // namespace
}  // namespace limpid
