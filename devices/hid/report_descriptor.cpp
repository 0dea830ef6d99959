#include "devices/hid/report_descriptor.h"

#include <fmt/format.h>

#include <algorithm>

#include "devices/hid/hid_transport.h"

namespace limpid {

namespace {

constexpr std::uint8_t kLongItem = 0xFE;
constexpr const char* kCutOff = "the end of the item is missing";

constexpr std::size_t kMaxDescriptor = 4096;  // as in the kernel
constexpr std::size_t kMaxFields = 2048;
constexpr std::size_t kMaxUsages = 1024;  // of an item; more are left out
constexpr std::size_t kMaxDepth = 16;     // of collections, and of pushes
constexpr std::uint32_t kMaxReportBits = 8 * HidTransport::kMaxReport;

// A maximum of a field, whose sign is known only with the minimum.
struct Bound {
  std::int64_t as_signed = 0;
  std::int64_t as_unsigned = 0;
};

struct Globals {
  std::uint16_t usage_page = 0;
  std::int64_t logical_min = 0;
  Bound logical_max;
  std::int64_t physical_min = 0;
  Bound physical_max;
  std::uint32_t unit = 0;
  int unit_exponent = 0;
  std::uint32_t report_size = 0;
  std::uint32_t report_count = 0;
  std::uint8_t report_id = 0;
};

struct LocalUsage {
  std::uint32_t value = 0;
  bool has_page = false;
};

struct Locals {
  std::vector<LocalUsage> usages;
  LocalUsage minimum;
  bool in_delimiter = false;
  bool alternative = false;  // to a usage taken already
};

std::int64_t pick(std::int64_t minimum, const Bound& maximum) {
  return minimum < 0 ? maximum.as_signed : maximum.as_unsigned;
}

class Parser {
 public:
  explicit Parser(std::span<const std::uint8_t> bytes) : items_(bytes) {}

  ReportDescriptor parse() {
    while (const auto item = items_.next()) take(*item);
    if (!collections_.empty()) throw HidError("report descriptor: a collection is not closed");
    return std::move(descriptor_);
  }

 private:
  void take(const ReportItem& item) {
    switch (item.type) {
      case ReportItem::kMain: return take_main(item);
      case ReportItem::kGlobal: return take_global(item);
      case ReportItem::kLocal: return take_local(item);
      default: return;  // reserved
    }
  }

  void take_main(const ReportItem& item) {
    switch (item.tag) {
      case 0x8: add_fields(item, ReportKind::input); break;
      case 0x9: add_fields(item, ReportKind::output); break;
      case 0xB: add_fields(item, ReportKind::feature); break;
      case 0xA: open_collection(item); break;
      case 0xC: close_collection(item); break;
      default: break;
    }
    locals_ = {};
  }

  void open_collection(const ReportItem& item) {
    if (collections_.size() == kMaxDepth) refuse(item, "collections are nested too deeply");
    const Usage usage = locals_.usages.empty() ? 0 : full(locals_.usages.front());
    if (collections_.empty()) descriptor_.applications.push_back(usage);
    collections_.push_back(usage);
  }

  void close_collection(const ReportItem& item) {
    if (collections_.empty()) refuse(item, "the item closes a collection that is not open");
    collections_.pop_back();
  }

  void take_global(const ReportItem& item) {
    switch (item.tag) {
      case 0x0: globals_.usage_page = static_cast<std::uint16_t>(item.value); break;
      case 0x1: globals_.logical_min = item.as_signed(); break;
      case 0x2: globals_.logical_max = {item.as_signed(), item.value}; break;
      case 0x3: globals_.physical_min = item.as_signed(); break;
      case 0x4: globals_.physical_max = {item.as_signed(), item.value}; break;
      case 0x5: globals_.unit_exponent = exponent(item); break;
      case 0x6: globals_.unit = item.value; break;
      case 0x7: globals_.report_size = item.value; break;
      case 0x8: take_report_id(item); break;
      case 0x9: globals_.report_count = item.value; break;
      case 0xA:
        if (pushed_.size() == kMaxDepth) refuse(item, "too many pushes");
        pushed_.push_back(globals_);
        break;
      case 0xB:
        if (pushed_.empty()) refuse(item, "a pop without a push");
        globals_ = pushed_.back();
        pushed_.pop_back();
        break;
      default: break;
    }
  }

  // Reads an exponent: four bits by the standard, a signed number in many devices.
  static int exponent(const ReportItem& item) {
    if (item.value <= 0xF)
      return item.value < 8 ? static_cast<int>(item.value) : static_cast<int>(item.value) - 16;
    return static_cast<int>(item.as_signed());
  }

  void take_report_id(const ReportItem& item) {
    if (item.value == 0 || item.value > 255) refuse(item, "a report's id is 1 to 255");
    if (!descriptor_.numbered && any_report_)
      refuse(item, "some reports have an id, others have none");
    descriptor_.numbered = true;
    globals_.report_id = static_cast<std::uint8_t>(item.value);
  }

  void take_local(const ReportItem& item) {
    const LocalUsage usage{item.value, item.size == 4};
    switch (item.tag) {
      case 0x0:
        if (!locals_.alternative) add_usage(usage);
        locals_.alternative = locals_.in_delimiter;
        break;
      case 0x1: locals_.minimum = usage; break;
      case 0x2: add_usage_range(usage); break;
      case 0xA:
        locals_.in_delimiter = item.value == 1;
        locals_.alternative = false;
        break;
      default: break;
    }
  }

  void add_usage(const LocalUsage& usage) {
    if (locals_.usages.size() < kMaxUsages) locals_.usages.push_back(usage);
  }

  // Adds a range of usages. In a set of alternatives it counts as a single one; no device is known
  // to do that.
  void add_usage_range(const LocalUsage& maximum) {
    if (locals_.alternative) return;
    locals_.alternative = locals_.in_delimiter;
    const bool has_page = locals_.minimum.has_page || maximum.has_page;
    for (std::uint64_t value = locals_.minimum.value;
         value <= maximum.value && locals_.usages.size() < kMaxUsages; ++value) {
      add_usage({static_cast<std::uint32_t>(value), has_page});
    }
  }

  Usage full(const LocalUsage& usage) const {
    return usage.has_page
               ? usage.value
               : make_usage(globals_.usage_page, static_cast<std::uint16_t>(usage.value));
  }

  void add_fields(const ReportItem& item, ReportKind kind) {
    any_report_ = true;
    const std::uint32_t size = globals_.report_size;
    const std::uint32_t count = globals_.report_count;
    auto& bits = descriptor_.report_bits[static_cast<std::size_t>(kind)][globals_.report_id];
    const std::uint32_t offset = bits == 0 ? 8 : bits;
    if (static_cast<std::uint64_t>(size) * count > kMaxReportBits - offset) {
      refuse(item, "the report is too long");
    }
    bits = offset + size * count;
    const bool padding = item.value & 1;
    if (padding || size == 0 || size > 32 || count == 0) return;

    const bool array = !(item.value & 2);
    ReportField field = shared(kind, array);
    field.bit_offset = offset;
    if (array) {
      for (const LocalUsage& usage : locals_.usages) field.usages.push_back(full(usage));
      field.count = count;
      add(item, std::move(field));
      return;
    }
    // Adds a field for each usage; the last one has all remaining values.
    const std::size_t fields = std::clamp<std::size_t>(locals_.usages.size(), 1, count);
    for (std::size_t i = 0; i < fields; ++i) {
      ReportField one = field;
      one.bit_offset = offset + static_cast<std::uint32_t>(i) * size;
      one.count = i + 1 == fields ? count - static_cast<std::uint32_t>(i) : 1;
      if (!locals_.usages.empty()) one.usages = {full(locals_.usages[i])};
      add(item, std::move(one));
    }
  }

  ReportField shared(ReportKind kind, bool array) const {
    ReportField field;
    field.kind = kind;
    field.report_id = globals_.report_id;
    field.bit_size = globals_.report_size;
    field.array = array;
    field.logical_min = globals_.logical_min;
    field.logical_max = pick(globals_.logical_min, globals_.logical_max);
    field.physical_min = globals_.physical_min;
    field.physical_max = pick(globals_.physical_min, globals_.physical_max);
    if (field.physical_min == 0 && field.physical_max == 0) {
      field.physical_min = field.logical_min;
      field.physical_max = field.logical_max;
    }
    field.unit = globals_.unit;
    field.unit_exponent = globals_.unit_exponent;
    field.collections = collections_;
    return field;
  }

  void add(const ReportItem& item, ReportField field) {
    if (descriptor_.fields.size() == kMaxFields) refuse(item, "too many fields");
    descriptor_.fields.push_back(std::move(field));
  }

  ReportItems items_;
  ReportDescriptor descriptor_;
  Globals globals_;
  Locals locals_;
  std::vector<Globals> pushed_;
  std::vector<Usage> collections_;
  bool any_report_ = false;
};

// The first bit of the value; nothing if the value is not wholly in the report.
std::optional<std::uint64_t> first_bit(std::size_t bytes, const ReportField& field,
                                       std::uint32_t index) {
  const std::uint64_t first = field.bit_offset + static_cast<std::uint64_t>(index) * field.bit_size;
  if (field.bit_size < 1 || field.bit_size > 32 || index >= field.count ||
      first + field.bit_size > 8 * static_cast<std::uint64_t>(bytes)) {
    return std::nullopt;
  }
  return first;
}

bool fits(std::int64_t value, const ReportField& field) {
  const std::int64_t values = std::int64_t{1} << field.bit_size;
  if (field.logical_min < 0) return value >= -values / 2 && value < values / 2;
  return value >= 0 && value < values;
}

constexpr Usage kFirst = make_usage(0x09, 1);
constexpr Usage kLast = make_usage(0x09, 32);

}  // namespace

std::int64_t ReportItem::as_signed() const {
  if (size == 1) return static_cast<std::int8_t>(value);
  if (size == 2) return static_cast<std::int16_t>(value);
  return static_cast<std::int32_t>(value);
}

void refuse(const ReportItem& item, std::string_view what) {
  throw HidError(fmt::format("report descriptor, byte {}: {}", item.offset, what));
}

std::optional<ReportItem> ReportItems::next() {
  skip_long_items();
  if (at_ == bytes_.size()) return std::nullopt;
  const std::uint8_t prefix = bytes_[at_];
  ReportItem item;
  item.offset = at_;
  item.type = (prefix >> 2) & 3;
  item.tag = prefix >> 4;
  item.size = (prefix & 3) == 3 ? 4 : prefix & 3;
  if (bytes_.size() - at_ - 1 < item.size) refuse(item, kCutOff);
  for (std::size_t i = 0; i < item.size; ++i) {
    item.value |= static_cast<std::uint32_t>(bytes_[at_ + 1 + i]) << (8 * i);
  }
  at_ += 1u + item.size;
  return item;
}

void ReportItems::skip_long_items() {
  while (at_ < bytes_.size() && bytes_[at_] == kLongItem) {
    ReportItem item;
    item.offset = at_;
    const std::size_t left = bytes_.size() - at_;
    if (left < 2 || left < 3u + bytes_[at_ + 1]) refuse(item, kCutOff);
    at_ += 3u + bytes_[at_ + 1];
  }
}

bool ReportField::within(Usage collection) const {
  return std::find(collections.begin(), collections.end(), collection) != collections.end();
}

std::size_t ReportDescriptor::report_bytes(ReportKind kind, std::uint8_t id) const {
  return (report_bits[static_cast<std::size_t>(kind)][id] + 7) / 8;
}

const ReportField* ReportDescriptor::find(ReportKind kind, Usage usage, Usage within) const {
  for (const ReportField& field : fields) {
    if (field.kind != kind || (within != 0 && !field.within(within))) continue;
    if (std::find(field.usages.begin(), field.usages.end(), usage) != field.usages.end()) {
      return &field;
    }
  }
  return nullptr;
}

ReportDescriptor parse_report_descriptor(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > kMaxDescriptor) {
    throw HidError(fmt::format("report descriptor: {} bytes; allowed: at most {}", bytes.size(),
                               kMaxDescriptor));
  }
  return Parser(bytes).parse();
}

std::optional<std::int64_t> get_field(std::span<const std::uint8_t> report,
                                      const ReportField& field, std::uint32_t index) {
  const auto first = first_bit(report.size(), field, index);
  if (!first) return std::nullopt;
  std::int64_t value = 0;
  for (std::uint32_t i = 0; i < field.bit_size; ++i) {
    const std::uint64_t bit = *first + i;
    value |= static_cast<std::int64_t>(report[bit / 8] >> (bit % 8) & 1) << i;
  }
  const std::int64_t sign = std::int64_t{1} << (field.bit_size - 1);
  const bool negative = field.logical_min < 0 && (value & sign);
  return negative ? value - 2 * sign : value;
}

bool put_field(std::span<std::uint8_t> report, const ReportField& field, std::int64_t value,
               std::uint32_t index) {
  const auto first = first_bit(report.size(), field, index);
  if (!first || !fits(value, field)) return false;
  for (std::uint32_t i = 0; i < field.bit_size; ++i) {
    const std::uint64_t bit = *first + i;
    const auto mask = static_cast<std::uint8_t>(1u << (bit % 8));
    std::uint8_t& byte = report[bit / 8];
    byte = static_cast<std::uint8_t>((value >> i & 1) ? byte | mask : byte & ~mask);
  }
  return true;
}

std::vector<ReportField> button_fields(const ReportDescriptor& descriptor) {
  std::vector<ReportField> buttons;
  for (const ReportField& field : descriptor.fields) {
    const bool one_button = field.kind == ReportKind::input && !field.array &&
                            field.bit_size == 1 && field.usages.size() == 1;
    if (one_button && field.usages[0] >= kFirst && field.usages[0] <= kLast) {
      buttons.push_back(field);
    }
  }
  return buttons;
}

bool decode_buttons(std::span<const std::uint8_t> report, std::span<const ReportField> fields,
                    std::uint32_t& pressed, std::uint32_t& known) noexcept {
  bool any = false;
  for (const ReportField& field : fields) {
    if (report.empty() || report[0] != field.report_id) continue;
    const auto down = get_field(report, field);
    if (!down) continue;
    const std::uint32_t bit = 1u << (field.usages[0] - kFirst);
    pressed = *down ? pressed | bit : pressed & ~bit;
    known |= bit;
    any = true;
  }
  return any;
}

}  // namespace limpid
