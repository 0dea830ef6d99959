// Path of a hand over time: from a CSV file, from a recorded session, or through chosen points.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/math/sizes.h"
#include "devices/files/session/session.h"

namespace limpid {

// Wanted positions of a hand's tip. N >= 1 samples, time increasing, and a monotone cubic (PCHIP)
// between them: smooth (C1), without overshoot. Before the first and after the last sample the hand
// rests there. Asking never allocates.
struct HandPath {
  std::vector<double> time;    // N, from 0 [s]
  std::vector<Vec3> position;  // N [m]
  std::vector<Vec3> velocity;  // N, of the cubic at the samples [m/s]
  std::vector<double> grip;    // N, 1 the hand holds, 0 it let go [-]
  std::vector<bool> magnet;    // N, picks up bodies; empty: never
  std::vector<BodyPull> pull;  // N, pulls on bodies besides; empty: never
  std::string source;          // the file, for people
  double tick = 0;             // T of the session that it came from [s]; 0 from CSV

  // Duration [s]; a session's is N ticks, so that feeding it back gives as many rows.
  double duration() const {
    return tick > 0 ? tick * static_cast<double>(time.size()) : time.back();
  }

  Vec3 at(double t) const;         // t [s] after the first sample; exact at samples
  double grip_at(double t) const;  // held from sample to sample

  // Values at the k-th tick of a loop with tick T: the recorded row itself if the session's tick is
  // T.
  Vec3 sample(std::size_t k, double T) const;
  double grip_sample(std::size_t k, double T) const;
  bool magnet_sample(std::size_t k, double T) const;
  BodyPull pull_sample(std::size_t k, double T) const;

 private:
  std::size_t row(std::size_t k, double T) const;
  std::size_t row_at(double t) const;
};

// Reads CSV with the header `time_s,x_m,y_m,z_m[,magnet][,...]` (magnet: 0 or 1, from that sample
// on; further columns are ignored), or a session (.h5, .h5.part). Errors: FileError "FILE:LINE:
// ..." for a wrong header, fewer than 2 samples, anything that is not a finite number, time that
// does not increase, a point beyond 10 m.
HandPath read_hand(const std::filesystem::path& file);

// The hand of a session in memory; `where` names the session. Errors: FileError.
HandPath hand_of(const Session& session, const std::string& where);

// A hand that moves through N >= 1 points at times that increase from 0 [m, s], and holds
// throughout.
HandPath hand_through(std::vector<double> time, std::vector<Vec3> position, std::string source);

HandPath parse_hand_csv(const std::string& text, const std::string& where);

}  // namespace limpid
