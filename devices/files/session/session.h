// Names and sizes that writer and reader of session files agree on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/large_memory.h"
#include "core/tick/row.h"
#include "devices/files/scene_files.h"
#include "devices/files/text_file.h"

namespace limpid {

inline constexpr const char* kSessionFormat = "limpid-session";
// In version 1 joints that slide counted in units of 0.1 m, and contacts that were not there were
// at zero. Both are read.
inline constexpr int kSessionVersion = 2;
inline constexpr std::size_t kSettingLength = 120;
inline constexpr const char* kEventRowPath = "/events/row";
inline constexpr const char* kTwinGroup = "twin";  // of the second run, if there is one
inline constexpr const char* kRoundingPath = "/check/rounding";
inline constexpr const char* kJointTypes = "joint_types";  // attribute of the root
inline constexpr const char* kSlidingType = "prismatic";   // URDF's words
inline constexpr const char* kTurningType = "revolute";
inline constexpr const char* kEventSettingPath = "/events/setting";
inline constexpr const char* kMarkTickPath = "/marks/tick";
inline constexpr const char* kMarkTextPath = "/marks/text";
inline constexpr std::size_t kMarkLength = 200;  // bytes of UTF-8
inline constexpr std::size_t kMostMarks = 100'000;
inline constexpr const char* kWorldPath = "/objects/state";
inline constexpr std::size_t kMostWorld = 100'000;  // numbers
inline constexpr const char* kStory = "story";      // attribute of the root
inline constexpr const char* kBodyNames = "names";  // attribute of what is said of each body

// What a row reads as that was announced but never written, in recordings of the first edition: a
// not-a-number that no arithmetic makes.
inline constexpr std::uint64_t kNeverWritten = 0x7ff8'6c69'6d70'6964;

// The same below a group: a session's datasets stand at the root, a twin's in a group of its own.
inline const char* within_group(const char* path) { return path + 1; }

inline std::size_t column_index(Column c) { return static_cast<std::size_t>(c); }

// Session files: recorded ticks as HDF5, readable while being written, recoverable when killed.
struct ArmDescription;

struct SessionInfo {
  double tick = 0.001;  // T [s]
  int dof = 3;
  std::string created;  // ISO 8601; filled in by the writer if empty
  std::string app_version;
  std::string build;  // what program on what kind of processor made it; empty: it does not say
  std::uint64_t seed = 0;
  std::string source;       // what the hand was
  std::string config;       // all parameters at row 0 (TOML)
  std::string safety;       // the safety limits in force (TOML); empty if none were recorded
  std::string device_urdf;  // whole text
  std::string scene;        // whole text (TOML)
  std::string story;        // that it tells: captions and the like; empty: none
  SceneFiles models;        // that the scene's text names
  // Whose rows they are. Readers leave it out: device_urdf has it. A file that is written without
  // it has neither tips nor names of joints.
  std::shared_ptr<const ArmDescription> arm;
  std::vector<bool>
      slides;  // of each joint, as far as the file says; empty: none is known to slide
  std::vector<std::string> bodies;  // what the objects that move are called, in the rows' order
  // All parameters at row 0 of a second run on the same hand (TOML); none: there is one run.
  std::optional<std::string> twin;

  RowLayout layout() const { return RowLayout(dof, static_cast<int>(bodies.size())); }
};

// A parameter that changed while recording: from `row` on, `setting` ("coupling.k_vc = 8") holds.
struct SettingChange {
  std::uint64_t row = 0;
  std::string setting;  // at most 120 characters; no value: back to the arm's own

  std::string_view key() const { return std::string_view(setting).substr(0, setting.find(' ')); }
};

// What somebody noted at a moment of a recording: a comment, or why it is worth another look.
struct Mark {
  std::uint64_t tick = 0;  // its row
  std::string text;        // at most kMarkLength bytes

  friend bool operator==(const Mark&, const Mark&) = default;
};

struct Session {
  SessionInfo info;
  RowLayout layout{3};
  LargeVector<double> rows;  // N x layout.stride(), row-major
  std::vector<SettingChange> changes;
  std::vector<Mark> marks;  // in the order of their ticks
  // All that the loop keeps of its bodies at the first row, as RigStart has it. Empty: they begin
  // as the scene has them, or it is not known.
  std::vector<double> world;
  // The second run on the same hand, as a session of its own: as many rows, its own parameters and
  // changes, the same world. Null: there is one run.
  std::shared_ptr<const Session> twin;

  std::size_t size() const { return rows.size() / static_cast<std::size_t>(layout.stride()); }
  std::span<const double> row(std::size_t k) const {
    const auto stride = static_cast<std::size_t>(layout.stride());
    return std::span(rows).subspan(k * stride, stride);
  }
  std::span<const double> at(std::size_t k, Column c) const { return layout.in(row(k), c); }
};

// Which of a twin's runs.
inline constexpr std::size_t kMainLane = 0, kTwinLane = 1;

// Whether a session that is complete is packed. That takes several times as long as writing it.
enum class Packing { no, yes };

// Writes OUT.h5.part while running (SWMR: readable live), which OUT.h5 takes the place of when it
// is closed: the same, packed where the file system has files without a name and room for it. Rows
// reach the disk at least every three quarters of a second of ticks. Not for the haptic thread.
// Errors: FileError if OUT exists and `force` is not set, the place cannot be written, or a write
// fails (disk full); after a failed write the .part keeps what had been flushed.
class SessionWriter {
 public:
  SessionWriter(std::filesystem::path out, const SessionInfo& info, bool force,
                Packing packing = Packing::yes);
  ~SessionWriter();  // without close(): leaves the .part, as a killed program would
  SessionWriter(const SessionWriter&) = delete;
  SessionWriter& operator=(const SessionWriter&) = delete;

  // Any whole number of rows. Of a twin both runs get as many.
  void append(std::span<const double> rows, std::size_t lane = kMainLane);
  void append(const SettingChange& change, std::size_t lane = kMainLane);
  void append(const Mark& mark);
  // What the loop keeps of bodies at the first row, at most kMostWorld numbers; at most once, and
  // before that row. Of a session without bodies nothing is kept.
  void append_world(std::span<const double> world, std::size_t lane = kMainLane);
  // Flush, close, rename. `warnings`: sentences about the run, one a line, for the attribute of
  // that name; empty: there is none.
  void close(const std::string& warnings = {});
  std::uint64_t rows_written() const;  // handed over so far
  const std::filesystem::path& part() const;
  bool is_locked() const;  // against other programs; false where the file system has no locks

 private:
  struct File;
  std::unique_ptr<File> file_;
};

// Reads OUT.h5, or the .part of a recording that is running or was killed (the rows that are
// complete in every column). Errors: FileError for a file that is missing, not HDF5, not a
// session, of another version, of inconsistent shapes, or with times that are not finite.
Session read_session(const std::filesystem::path& file);

// Errors: FileError naming `file`, for a text that is longer than is kept.
void check_mark(const Mark& mark, const std::filesystem::path& file);
// Puts `marks` in place of the marks of a session that is complete; what is neither among them nor
// `known` is another program's mark, and stays. A copy gets them, by a program in a sandbox, and
// takes the session's place once it is on the disk: the session is there, whole, at any moment.
// Errors: FileError, and the session is as before; for one that another program changed meanwhile,
// or where there would be more than kMostMarks.
void write_marks(const std::filesystem::path& session, std::span<const Mark> marks,
                 std::span<const Mark> known);

// A leftover is whole, and has no rows.
class NothingRecorded : public FileError {
 public:
  using FileError::FileError;
};

// Makes OUT.h5 (or `to`, where that is given) of OUT.h5.part (through a clean copy) and removes the
// .part. Returns the new path and the rows saved. Errors: as read_session; FileError if the new
// file exists and not `force`, or there are no rows; the .part stays then.
struct Recovered {
  std::filesystem::path file;
  std::uint64_t rows = 0;
};
Recovered recover_session(const std::filesystem::path& part, bool force,
                          const std::filesystem::path& to = {});

}  // namespace limpid
