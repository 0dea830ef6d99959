// Exchange with the program limpid-session, as bytes through a pipe. Numbers are as in memory;
// before each text and list stands its length. Both ends are of one build.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "devices/files/session/session.h"
#include "devices/files/session/session_marks.h"
#include "devices/files/session/session_stream.h"

namespace limpid {
namespace wire {

// Error: the other end is gone, or sends no session, story or table.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// First number of all, and before each piece of a session's rows: the kind of what follows.
enum class Answer : std::uint64_t { refusal, contents, rows, end };

class Writer {
 public:
  explicit Writer(int to) : to_(to) {}

  void bytes(std::span<const unsigned char> all);
  template <class Number>
  void number(Number value) {
    static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
    bytes({reinterpret_cast<const unsigned char*>(&value), sizeof value});
  }
  template <class Value>
  void list(std::span<const Value> values) {
    static_assert(std::is_arithmetic_v<Value>);
    number<std::uint64_t>(values.size());
    bytes({reinterpret_cast<const unsigned char*>(values.data()), values.size_bytes()});
  }
  void text(const std::string& value) { list(std::span<const char>(value)); }

 private:
  int to_;
};

// Reads with distrust: takes memory as the bytes arrive.
class Reader {
 public:
  // `most`: bytes in all, or in each piece.
  Reader(int from, std::uint64_t most) : from_(from), most_(most), left_(most) {}

  void begin_piece() { left_ = most_; }

  void bytes(std::span<unsigned char> all);
  template <class Number>
  Number number() {
    Number value{};
    bytes({reinterpret_cast<unsigned char*>(&value), sizeof value});
    return value;
  }
  template <class List>
  List list() {
    using Value = typename List::value_type;
    static_assert(std::is_arithmetic_v<Value>);
    constexpr std::size_t kPiece = (1 << 20) / sizeof(Value);
    const std::size_t count = taken(sizeof(Value));
    List values;
    values.reserve(count);
    while (values.size() < count) {
      const std::size_t from = values.size(), more = std::min(kPiece, count - from);
      values.resize(from + more);
      bytes({reinterpret_cast<unsigned char*>(values.data() + from), more * sizeof(Value)});
    }
    return values;
  }
  std::string text() { return list<std::string>(); }
  // Reads how many things of at least `size` bytes follow. Errors: Broken if they would be too
  // many.
  std::size_t taken(std::size_t size);

 private:
  int from_;
  std::uint64_t most_, left_;
};

// Write a session in pieces: first its contents, the number of rows that it claims, changes and
// objects; rows as often as there are some; then its marks.
void put_about(Writer& to, const Session& session, std::uint64_t rows);
void put_rows(Writer& to, LaneRows rows);
void put_rest(Writer& to, const Session& session);
void put_session(Writer& to, const Session& session);  // all pieces
// Reads a session; `begins` is told how many rows are claimed. Errors: Broken; FileError for what
// the other end refuses on the way.
Session take_session(Reader& from,
                     const std::function<void(const Session& about, std::uint64_t rows)>& begins,
                     const TakeRows& take);
Session take_session(Reader& from);
void put_order(Writer& to, const MarkOrder& order);
MarkOrder take_order(Reader& from);

// Attributes and columns of a file of numbers that is no session.
struct Table {
  std::map<std::string, std::string> texts;
  std::map<std::string, std::uint64_t> counts;
  std::map<std::string, std::vector<double>> columns;  // by path, as "/measure/energy"
};
void put_table(Writer& to, const Table& table);
Table take_table(Reader& from);

}  // namespace wire

// Name of the program.
inline constexpr const char* kSessionProgram = "limpid-session";
inline constexpr int kCopyToChange = 3;  // descriptor of the copy in the program

// Reads texts, whole numbers and columns of a sweep's table. Errors: FileError for what is no
// table, is damaged, or crashes its reader.
wire::Table read_table(const std::filesystem::path& file);

// Writes marks, as write_marks() does, into the copy of a session that `descriptor` is open for.
// Errors: FileError naming `file`.
void write_marks_into(const std::filesystem::path& file, int descriptor, const MarkOrder& order);

}  // namespace limpid
