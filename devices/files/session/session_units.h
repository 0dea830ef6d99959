// Units of a session file where they differ from a row's: metres and newtons of joints that slide,
// and no place for a contact that is not there.
//
// A row counts the travel of a slide in kSlideUnit; the file has SI. Scaling rounds, so that
// several numbers of rows become one number of the file. The file therefore also holds how many
// doubles lie between the row's number and the one scaled back. Every row comes back to the last
// bit.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/tick/row.h"

namespace limpid {

struct ArmDescription;

std::vector<bool> slides_of(const ArmDescription& arm);  // of each joint

class SessionUnits {
 public:
  // `slides`: of each joint; empty: none slides.
  SessionUnits(const RowLayout& layout, const std::vector<bool>& slides);

  // A number of each row that has another unit in the file.
  struct Scaled {
    Column column;
    int part;     // index within the column
    bool effort;  // torques become forces; else angles become lengths
  };
  const std::vector<Scaled>& scaled() const { return scaled_; }

  // The file's units of a column's parts; a single one if all have the same. For bodies, those of
  // one body.
  std::vector<std::string> units(const ColumnInfo& column) const;

  // A row's number in the file: the value, and how many doubles the row's number lies beyond the
  // value scaled back.
  struct Filed {
    double value;
    std::int8_t rounding;
  };
  static Filed filed(const Scaled& scaled, double x);
  // Gives the row's number back; nothing if no number can have given these two.
  static std::optional<double> unfiled(const Scaled& scaled, const Filed& filed);
  // Gives it as near as possible from the value alone.
  static double unfiled(const Scaled& scaled, double value);

 private:
  RowLayout layout_;
  std::vector<bool> slides_;
  std::vector<Scaled> scaled_;
};

// Units of a norm over all joints, for people. If some joints turn and others slide, a radian
// counts as a decimetre and 1 N m as 10 N, as in the rows.
struct NormUnits {
  const char *angle, *milliangle, *torque;
  double angles = 1, torques = 1;  // so many of these units make one of the rows'
};
NormUnits norm_units(const std::vector<bool>& slides);

// Convert points of contacts: not a number in the file, and zero in rows, where nothing touches.
void file_points(std::span<double> points, std::span<const double> forces);
void unfile_points(std::span<double> points, std::span<const double> forces);

}  // namespace limpid
