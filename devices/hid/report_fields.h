// The number of a field in the bytes of a report.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "devices/hid/report_descriptor.h"

namespace limpid {

// Value `index` of the field; nothing if the report is too short for it.
std::optional<std::int64_t> get_field(std::span<const std::uint8_t> report,
                                      const ReportField& field, std::uint32_t index = 0);

// Sets it; false, and nothing done, if it lies outside the report or the field's bits cannot hold
// the number.
bool put_field(std::span<std::uint8_t> report, const ReportField& field, std::int64_t value,
               std::uint32_t index = 0);

}  // namespace limpid
