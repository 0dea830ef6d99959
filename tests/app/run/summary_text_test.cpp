// A run's summary as people read it, line by line, and the table that compares runs.
#include <gtest/gtest.h>

#include <array>
#include <sstream>
#include <string>
#include <vector>

#include "app/run/summary.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

// Four rows of 1 ms; the times over `scale` are those of a second run.
test::Rows rows_to_sum_up(int bodies, double scale = 1) {
  const RowLayout layout(3, bodies);
  test::Rows rows(layout);
  constexpr std::array kError{0.01, 0.04, 0.02, 0.03}, kContact{0.0, 0.3, 0.3, 0.1},
      kHand{1.0, 2.0, 2.0, 4.0}, kTotal{0.001, 0.005, -0.002, 0.0025};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::span<double> row = rows.add();
    const auto set = [&](Column c, std::size_t part, double value) {
      layout.in(row, c)[part] = value;
    };
    set(Column::time, 0, 0.001 * static_cast<double>(k));
    set(Column::device_position, 0, 1 + scale * kError[k]);
    set(Column::proxy_position, 0, 1);
    set(Column::contact_torque, 1, -scale * kContact[k]);
    set(Column::hand_torque, 2, scale * kHand[k]);
    set(Column::energy_total, 0, scale * kTotal[k]);
    set(Column::energy_commanded, 0, kTotal[k] + 0.001);
    set(Column::governor, 0, 1);
    set(Column::torque_governor, 0, 1);
    if (bodies == 0) continue;
    const auto each = static_cast<double>(k);
    set(Column::energy_to_objects, 0, 0.001 * scale * (each + 1));
    set(Column::objects_gain, 0, k == 2 ? 2e-6 : 1e-6);
    set(Column::objects_awake, 0, k == 1 ? 2 : 1);
    set(Column::objects_left_out, 0, k == 1 ? 3 : 0);
    set(Column::objects_stood_still, 0, each);
    set(Column::objects_turned_less, 0, 2 * each);
  }
  return rows;
}

Summary summed_up(const test::Rows& rows, const std::vector<bool>& slides = {}) {
  Summary summary(rows.layout(), slides);
  for (std::size_t k = 0; k < rows.size(); ++k) summary.add(rows.row(k));
  return summary;
}

// A loop that becomes unstable in its fifth row, and is lost in its sixth.
test::Rows rows_that_grow() {
  test::Rows rows = rows_to_sum_up(0);
  for (const double speed : {2e3, 2e6}) {
    const std::vector<double> before(rows.row(rows.size() - 1).begin(),
                                     rows.row(rows.size() - 1).end());
    const std::span<double> row = rows.add();
    std::ranges::copy(before, row.begin());
    rows.layout().in(row, Column::time)[0] += 0.001;
    rows.layout().in(row, Column::device_velocity)[0] = -speed;
    rows.layout().in(row, Column::energy_total)[0] = 77;
  }
  return rows;
}

// The mean square of the hand's torque is 25/4.
const std::string kFigures =
    "in contact               75 %\n"
    "largest |x_E|            40.000 mrad\n"
    "largest |f2|             0.3000 N m\n"
    "rms human torque         2.5000 N m\n"
    "E_c total                2.500 mJ (highest 5.000 mJ)\n"
    "E_c commanded            3.500 mJ\n";

TEST(SummaryText, HasALineForEachFigure) {
  EXPECT_EQ(summed_up(rows_to_sum_up(0)).text(), "ticks                    4\n" + kFigures);
}

TEST(SummaryText, OfALoopThatIsLostHasTheFiguresOfBeforeAndTheReason) {
  EXPECT_EQ(summed_up(rows_that_grow()).text(),
            "ticks                    6\n"
            "unstable                 since t = 0.004 s: the speed of the device's joint 1 became "
            "larger than 1000 rad/s\n"
            "before this time\n" +
                kFigures);
}

TEST(SummaryText, SaysWhatObjectsDid) {
  EXPECT_EQ(summed_up(rows_to_sum_up(2)).text(),
            "ticks                    4\n" + kFigures +
                "to objects               4.000 mJ\n"
                "objects gained           0.002000 mJ at most\n"
                "objects that moved       2 of 2 at the same time\n"
                "contact points ignored   up to 3 in a tick; these points give no force\n"
                "objects stood still      3 ticks: the solver found no forces for the objects\n"
                "objects turned less      6 ticks: a body of a mechanism turns by at most one "
                "radian per tick\n");
}

// A slide's coordinate counts in 0.1 m, its torque in 10 N.
TEST(SummaryText, OfAnArmThatSlidesIsInMillimetresAndNewtons) {
  const std::string text = summed_up(rows_to_sum_up(0), {true, true, true}).text();
  EXPECT_NE(text.find("largest |x_E|            4.000 mm\n"), std::string::npos) << text;
  EXPECT_NE(text.find("largest |f2|             3.0000 N\n"), std::string::npos) << text;
  EXPECT_NE(text.find("rms human torque         25.0000 N\n"), std::string::npos) << text;
}

TEST(SummaryText, IsAboutTheRowOfTheStrongestContact) {
  const test::Rows rows = rows_to_sum_up(0);
  Summary summary(rows.layout());
  std::vector<bool> memorable;
  for (std::size_t k = 0; k < 4; ++k) memorable.push_back(summary.add(rows.row(k)));
  EXPECT_EQ(memorable, (std::vector{true, true, true, false}));
  EXPECT_TRUE(test::same_numbers(summary.memorable(), rows.row(2))) << "the last of equals";
  EXPECT_DOUBLE_EQ(summary.time(), 0.003);
}

// Cell of a table's line between two places, without spaces around it.
std::string table_cell(const std::string& line, std::size_t from, std::size_t to) {
  std::string cell = from < line.size() ? line.substr(from, to - from) : "";
  cell.erase(0, std::min(cell.find_first_not_of(' '), cell.size()));
  cell.erase(cell.find_last_not_of(' ') + 1);
  return cell;
}

std::vector<std::vector<std::string>> table_cells(const std::string& text) {
  std::vector<std::vector<std::string>> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::size_t at = 0;
    for (const std::size_t end : {24, 41, 58, 64, 75}) {
      cells.push_back(table_cell(line, at, end));
      at = end;
    }
    all.push_back(std::move(cells));
  }
  return all;
}

// The second run has half of the first's angles and torques, and all of its time in contact.
TEST(SummaryText, ComparesRunsBesideEachOther) {
  const Summary one = summed_up(rows_to_sum_up(1)), half = summed_up(rows_to_sum_up(1, 0.5));
  const std::array<const Summary*, 2> both{&one, &half};
  const std::array<std::string, 2> names{"standard", "predictive"};
  const std::vector<std::vector<std::string>> wanted{
      {"", "standard", "predictive", "", "ratio"},
      {"in contact", "75.0000", "75.0000", "%", "1"},
      {"largest |x_E|", "40.0000", "20.0000", "mrad", "0.5"},
      {"largest |f2|", "0.3000", "0.1500", "N m", "0.5"},
      {"rms human torque", "2.5000", "1.2500", "N m", "0.5"},
      {"E_c total", "2.5000", "1.2500", "mJ", "0.5"},
      {"E_c total, highest", "5.0000", "2.5000", "mJ", "0.5"},
      {"to objects", "4.0000", "2.0000", "mJ", "0.5"}};
  EXPECT_EQ(table_cells(Summary::beside(both, names)), wanted);
}

TEST(SummaryText, ComparesNothingWithZeroAndSaysWhichRunIsUnstable) {
  const Summary still = summed_up(rows_to_sum_up(0, 0)), lost = summed_up(rows_that_grow());
  const std::array<const Summary*, 2> both{&still, &lost};
  const std::array<std::string, 2> names{"direct", "tank"};
  const std::string text = Summary::beside(both, names);
  const auto cells = table_cells(text);
  ASSERT_EQ(cells.size(), 8u) << text;
  for (std::size_t i = 1; i < 7; ++i) EXPECT_EQ(cells[i][4], "-") << cells[i][0];
  EXPECT_EQ(cells[2][2], "40.0000") << "of before it became unstable";
  const std::string last =
      "tank is unstable since t = 0.004 s: the speed of the device's joint 1 became larger than "
      "1000 rad/s\n";
  EXPECT_EQ(text.substr(text.size() - last.size()), last);
  EXPECT_EQ(text.find("direct is"), std::string::npos);
}

}  // namespace
}  // namespace limpid
