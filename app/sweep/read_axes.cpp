#include "app/sweep/read_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/sobol.hpp>
#include <boost/random/uniform_01.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cctype>
#include <cmath>
#include <numeric>

#include "app/sweep/body_axis.h"
#include "core/math/elementary.h"
#include "devices/files/config_file.h"

namespace limpid {

namespace {

// Boost's distributions are the same everywhere, unlike the standard library's.
using Twister = boost::random::mt19937_64;

double unit(Twister& random) { return boost::random::uniform_01<double>()(random); }

constexpr std::size_t kLongestName = 40;
constexpr std::uint64_t kMostValues = 1'000'000;
constexpr Range kAnything{-1e300, 1e300};

// Keys that name neither a parameter nor a file.
using Kind = FieldInfo::Kind;
constexpr FieldInfo kOwnKeys[] = {
    {{0, 1e9, true, "N/m"}, kStiffnessKey, "", "Stiffness of the scene's surfaces"},
    {{1, kMaxDof}, kArmJointsKey, "", "", "", Kind::whole},
    {{1e-3, 1e3, false, "kg"}, kArmMassKey},
    {{0, 1e6}, kArmSeedKey, "", "", "", Kind::whole}};

constexpr const char* kScales[] = {"linear", "log"};

std::string stem(const std::string& file) { return std::filesystem::path(file).stem().string(); }

// Reads an axis of files: a case for each.
void read_files(const TomlTable& table, std::string SweepWorld::*part, SweepAxis& axis) {
  for (const std::string& file : table.texts("values")) {
    SweepCase& one = axis.cases.emplace_back();
    one.name = stem(file);
    one.world.*part = file;
  }
  if (axis.cases.empty()) table.refuse_missing("values");
}

void read_cases(const TomlTable& table, const Parameters& base, SweepAxis& axis) {
  for (const TomlTable& each : table.tables("cases")) {
    each.allow_only({"name", "set", "device", "scene", "hand"});
    SweepCase& one = axis.cases.emplace_back();
    one.name = each.need(each.text("name"), "name");
    one.settings = each.texts("set");
    one.world = {each.text("device").value_or(""), each.text("scene").value_or(""),
                 each.text("hand").value_or("")};
    Parameters tried = base;
    try {
      for (const std::string& setting : one.settings) apply_setting(tried, setting);
    } catch (const ParameterError& error) {
      each.refuse("set", error.what());
    }
  }
}

// Returns x. Refuses numbers that the axis' parameter does not allow.
double allowed_number(const TomlTable& table, const char* key, const SweepAxis& axis, double x) {
  const FieldInfo& field = *axis_field(axis.key);
  const bool whole = field.kind == Kind::whole;
  if (field.holds(x) && !(whole && x != std::floor(x))) return x;
  table.refuse(key,
               fmt::format("{}numbers {} {} to {}{}", whole ? "whole " : "",
                           field.exclusive_minimum ? "above" : "from", field.minimum, field.maximum,
                           field.has_unit() ? std::string(" ") + field.unit : ""));
}

std::vector<const char*> words_of(const FieldInfo& info) {
  if (info.kind == Kind::flag) return {"false", "true"};
  return {info.words.begin(), info.words.end()};
}

void read_words(const TomlTable& table, SweepAxis& axis) {
  const auto allowed = [&](std::string_view word) {
    return "a list of words from: " + allowed_for(word, axis.words);
  };
  const toml::node* node = table.find("values");
  if (node == nullptr) table.refuse_missing("values");
  if (!node->is_array()) table.refuse("values", allowed(""));
  for (const toml::node& each : *node->as_array()) {
    const auto text = each.value_exact<std::string>();
    const std::string word = text ? *text : found_text(each);
    const auto found = std::ranges::find(axis.words, word);
    if (found == axis.words.end()) table.refuse("values", allowed(word));
    axis.values.push_back(static_cast<double>(found - axis.words.begin()));
  }
}

void read_list(const TomlTable& table, SweepAxis& axis) {
  const toml::array* list = table.find("values")->as_array();
  if (list == nullptr || list->empty()) table.refuse("values", "a list of numbers");
  for (const toml::node& each : *list) {
    if (!each.is_number()) table.refuse("values", "a list of numbers");
    axis.values.push_back(allowed_number(table, "values", axis, *each.value<double>()));
  }
}

AxisRange read_range(const TomlTable& table, const SweepAxis& axis) {
  const AxisRange range{table.need(table.number("from", kAnything), "from"),
                        table.need(table.number("to", kAnything), "to")};
  allowed_number(table, "from", axis, range.from);
  allowed_number(table, "to", axis, range.to);
  if (!(range.to > range.from)) table.refuse("to", fmt::format("more than {}", range.from));
  if (axis.logarithmic && !(range.from > 0)) table.refuse("from", "above 0 on a log scale");
  return range;
}

double scaled(const AxisRange& range, double part, bool logarithmic) {
  if (part == 0) return range.from;
  if (part == 1) return range.to;
  return logarithmic ? range.from * power(range.to / range.from, part)
                     : range.from + (range.to - range.from) * part;
}

void refuse_key(const TomlTable& table, const std::string& key) {
  if (key.starts_with(kBodyKey)) table.refuse("key", body_properties());
  std::vector<std::string> keys{"device", "scene", "hand"};
  for (const FieldInfo& own : kOwnKeys) keys.emplace_back(own.key);
  for (const ParameterInfo& info : parameter_table()) keys.emplace_back(info.key);
  const auto meant = nearest(key, keys);
  table.refuse("key",
               "device, scene, hand, scene.stiffness, scene.body.NAME.PROPERTY, arm.joints, "
               "arm.mass, arm.seed, or a parameter that limpid run --help lists" +
                   (meant ? "; did you mean " + *meant + "?" : std::string()));
}

void read_numbers(const TomlTable& table, ReadAxis& read) {
  SweepAxis& axis = read.axis;
  axis.spread = static_cast<Spread>(table.choice("sample", kSpreads).value_or(0));
  axis.logarithmic = table.choice("scale", kScales) == 1;
  if (table.find("values") != nullptr) return read_list(table, axis);
  read.range = read_range(table, axis);
  if (axis.spread != Spread::grid) return;
  const std::uint64_t count = table.need(table.count("count", 2, kMostValues), "count");
  for (const double x : spread(read.range, count, axis.logarithmic)) {
    axis.values.push_back(allowed_number(table, "count", axis, x));
  }
}

// Returns the name of an axis to which the plan gives none.
std::string usual_name(const std::string& key) {
  return key == kStiffnessKey ? "wall" : key.substr(key.rfind('.') + 1);
}

// Refuses names unfit for columns and figures.
void check_name(const TomlTable& table, const std::string& name) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == ' ';
  };
  if (!name.empty() && name.size() <= kLongestName && std::ranges::all_of(name, plain)) return;
  table.refuse("name", fmt::format("up to {} letters, digits, _, - and spaces", kLongestName));
}

// Refuses a value that is there twice: its points would be run twice, and drawn on each other.
void refuse_doubles(const TomlTable& table, const SweepAxis& axis) {
  const auto twice = [](auto all) {
    std::ranges::sort(all);
    return std::ranges::adjacent_find(all) != all.end();
  };
  const auto refuse = [&](const char* key) {
    table.refuse(key, "each value only once; `repeats` runs all points several times");
  };
  if (table.find("cases") != nullptr) {
    if (twice(axis.words)) refuse("cases");
  } else if (table.find("values") != nullptr) {
    // Files of one name may be in several folders.
    if (axis.cases.empty() ? twice(axis.values) : twice(table.texts("values"))) refuse("values");
  }
}

}  // namespace

const FieldInfo* axis_field(const std::string& key) {
  if (const ParameterInfo* parameter = find_parameter(key)) return parameter;
  if (const FieldInfo* own = find_field(kOwnKeys, key)) return own;
  const auto of_body = body_axis(key);
  return of_body && of_body->property ? of_body->property->field : nullptr;
}

std::string words_of_axis(const SweepAxis& axis) {
  const FieldInfo* field = axis_field(axis.key);
  const bool named = axis.name != usual_name(axis.key);
  return field == nullptr || named || field->caption[0] == '\0' ? axis.name : field->caption;
}

UnitSamples random_samples(std::size_t dimensions, std::size_t count, std::uint64_t seed) {
  Twister random(seed);
  UnitSamples samples(dimensions, std::vector<double>(count));
  for (auto& dimension : samples) {
    for (double& x : dimension) x = unit(random);
  }
  return samples;
}

UnitSamples latin_samples(std::size_t dimensions, std::size_t count, std::uint64_t seed) {
  Twister random(seed);
  UnitSamples samples(dimensions, std::vector<double>(count));
  std::vector<std::size_t> cell(count);
  for (auto& dimension : samples) {
    std::iota(cell.begin(), cell.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i) {  // Fisher and Yates
      std::swap(cell[i - 1],
                cell[boost::random::uniform_int_distribution<std::size_t>(0, i - 1)(random)]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      dimension[i] = (static_cast<double>(cell[i]) + unit(random)) / static_cast<double>(count);
    }
  }
  return samples;
}

UnitSamples sobol_samples(std::size_t dimensions, std::size_t count, std::uint64_t seed) {
  Twister random(seed);
  std::vector<double> shift(dimensions);
  for (double& s : shift) s = unit(random);
  boost::random::sobol sequence(dimensions);
  UnitSamples samples(dimensions, std::vector<double>(count));
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t d = 0; d < dimensions; ++d) {
      const double x = static_cast<double>(sequence() >> 11) * 0x1p-53 + shift[d];
      samples[d][i] = x - std::floor(x);
    }
  }
  return samples;
}

std::vector<double> spread(const AxisRange& range, std::uint64_t count, bool logarithmic) {
  std::vector<double> values;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(count - 1);
    values.push_back(scaled(range, part, logarithmic));
  }
  return values;
}

ReadAxis read_axis(const TomlTable& table, const Parameters& base) {
  table.allow_only({"key", "name", "values", "from", "to", "count", "scale", "sample", "cases"});
  ReadAxis read;
  SweepAxis& axis = read.axis;
  if (table.find("cases") != nullptr) {
    axis.name = table.need(table.text("name"), "name");
    read_cases(table, base, axis);
  } else {
    const std::string key = table.need(table.text("key"), "key");
    axis.name = table.text("name").value_or(usual_name(key));
    const FieldInfo* field = axis_field(key);
    if (key == "device") {
      read_files(table, &SweepWorld::device, axis);
    } else if (key == "scene") {
      read_files(table, &SweepWorld::scene, axis);
    } else if (key == "hand") {
      read_files(table, &SweepWorld::hand, axis);
    } else if (field == nullptr) {
      refuse_key(table, key);
    } else {
      axis.key = key;
      axis.unit = field->unit;
      std::ranges::copy(words_of(*field), std::back_inserter(axis.words));
      axis.words.empty() ? read_numbers(table, read) : read_words(table, axis);
    }
  }
  check_name(table, axis.name);
  for (const SweepCase& one : axis.cases) {
    axis.values.push_back(static_cast<double>(axis.words.size()));
    axis.words.push_back(one.name);
  }
  refuse_doubles(table, axis);
  return read;
}

void sample(std::vector<ReadAxis>& axes, std::uint64_t samples, std::uint64_t seed) {
  for (const auto& [way, draw] : {std::pair{Spread::random, &random_samples},
                                  {Spread::latin, &latin_samples},
                                  {Spread::sobol, &sobol_samples}}) {
    std::vector<ReadAxis*> these;
    for (ReadAxis& read : axes) {
      if (read.axis.spread == way) these.push_back(&read);
    }
    if (these.empty()) continue;
    const UnitSamples drawn = draw(these.size(), samples, seed);
    for (std::size_t d = 0; d < these.size(); ++d) {
      SweepAxis& axis = these[d]->axis;
      const FieldInfo* field = axis_field(axis.key);
      const bool whole = field != nullptr && field->kind == Kind::whole;
      AxisRange range = these[d]->range;
      if (whole) range.to += 1;  // each whole number has a cell of its own
      for (const double part : drawn[d]) {
        const double x = scaled(range, part, axis.logarithmic);
        axis.values.push_back(whole ? std::min(std::floor(x), these[d]->range.to) : x);
      }
    }
  }
}

SweepLimit read_limit(const TomlTable& table) {
  const std::string name = table.need(table.text("measure"), "measure");
  SweepLimit limit{find_measure(name), table.number("above", kAnything),
                   table.number("below", kAnything)};
  if (limit.measure == nullptr) table.refuse("measure", "a measure that limpid sweep --help lists");
  if (!limit.measure->yes_no() && !limit.above && !limit.below) {
    table.refuse("measure",
                 "a measure that is yes or no; or another measure, with a key above or below");
  }
  return limit;
}

}  // namespace limpid
