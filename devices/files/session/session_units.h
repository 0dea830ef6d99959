// What a session file says otherwise than a row in memory does: metres and newtons of joints that
// slide, and that a contact which is not there has no place.
//
// A row counts the travel of a slide in kSlideUnit; the file has SI. Scaling rounds, and several
// numbers of rows become the same number of the file. So the file also holds how many doubles lie
// between the number that scaling back gives and the one that the row had: every row comes back to
// the last bit.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/tick/row.h"

namespace limpid {

struct ArmDescription;

std::vector<bool> slides_of(const ArmDescription& arm);  // each joint

class SessionUnits {
 public:
  // `slides`: whether each joint does; empty: none.
  SessionUnits(const RowLayout& layout, const std::vector<bool>& slides);

  // A number of each row that the file has in another unit.
  struct Scaled {
    Column column;
    int part;     // of the column
    bool effort;  // torques become forces, else angles become lengths
  };
  const std::vector<Scaled>& scaled() const { return scaled_; }

  // The file's unit of each part of a column; one where all have the same, and those of one body
  // where all bodies have the same.
  std::vector<std::string> units(const ColumnInfo& column) const;

  // Of a row's number: as the file has it, and how many doubles further on it lies than what
  // scaling that back gives.
  struct Filed {
    double value;
    std::int8_t rounding;
  };
  static Filed filed(const Scaled& scaled, double x);
  // And back; nothing where the two cannot have come from any number.
  static std::optional<double> unfiled(const Scaled& scaled, const Filed& filed);
  // As near as it goes where a file has but the value.
  static double unfiled(const Scaled& scaled, double value);

 private:
  RowLayout layout_;
  std::vector<bool> slides_;
  std::vector<Scaled> scaled_;
};

// What a length over all joints counts in, for people. Where some joints turn and others slide, it
// has a decimetre beside each radian and 10 N beside each N m, as the rows have.
struct NormUnits {
  const char *angle, *milliangle, *torque;
  double angles = 1, torques = 1;  // of these units in one of the rows'
};
NormUnits norm_units(const std::vector<bool>& slides);

// Points of contacts: not a number where nothing touches, which rows have at zero; and back.
void file_points(std::span<double> points, std::span<const double> forces);
void unfile_points(std::span<double> points, std::span<const double> forces);

}  // namespace limpid
