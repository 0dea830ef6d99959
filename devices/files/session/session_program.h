// What limpid-session says of a file, as bytes through a pipe: numbers as they are in memory, and
// before each text and list how many there are. Both ends are of one build.
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

namespace limpid::wire {

// The other end is gone, or what it says is no session, story or table.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The first number of all, and before each piece of a session's rows: what follows.
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

// Trusts nothing: memory is taken as the bytes arrive.
class Reader {
 public:
  // `most`: [bytes] in all, or in each piece.
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
  // How many follow, of at least `size` bytes each. Errors: Broken where those would be too many.
  std::size_t taken(std::size_t size);

 private:
  int from_;
  std::uint64_t most_, left_;
};

// A session in pieces: what it is of, how many rows it claims and what changed at them; rows as
// often as there are some; all else, with the changes at rows that are there.
void put_about(Writer& to, const Session& session, std::uint64_t rows);
void put_rows(Writer& to, std::span<const double> rows, std::span<const double> twin);
void put_rest(Writer& to, const Session& session);
void put_session(Writer& to, const Session& session);  // one after the other
// `begins` hears how many rows are claimed. Errors: Broken; FileError for what the other end
// refuses on the way.
Session take_session(Reader& from,
                     const std::function<void(const Session& about, std::uint64_t rows)>& begins,
                     const TakeRows& take);
Session take_session(Reader& from);
void put_order(Writer& to, const MarkOrder& order);
MarkOrder take_order(Reader& from);

// The attributes and columns of a file of numbers that is no session.
struct Table {
  std::map<std::string, std::string> texts;
  std::map<std::string, std::uint64_t> counts;
  std::map<std::string, std::vector<double>> columns;  // by path, as "/measure/energy"
};
void put_table(Writer& to, const Table& table);
Table take_table(Reader& from);

}  // namespace limpid::wire
namespace limpid {

// The program limpid-session, seen from the one that calls it.
inline constexpr const char* kSessionProgram = "limpid-session";
inline constexpr int kCopyToChange = 3;  // its descriptor there

// The texts, whole numbers and columns of a sweep's table. Errors: FileError for what is no table,
// damaged, or crashes what reads it.
wire::Table read_table(const std::filesystem::path& file);

// Does what write_marks() does to the copy of a session that `descriptor` is open for. Errors:
// FileError naming `file`.
void write_marks_into(const std::filesystem::path& file, int descriptor, const MarkOrder& order);

}  // namespace limpid
