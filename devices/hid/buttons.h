// The buttons that a device describes, as one bit each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "devices/hid/report_descriptor.h"

namespace limpid {

// Buttons 1 to 32 of the input reports, which are one bit each.
std::vector<ReportField> button_fields(const ReportDescriptor& descriptor);

// Takes those in this report into `buttons`; true if there are any.
bool decode_buttons(std::span<const std::uint8_t> report, std::span<const ReportField> fields,
                    std::uint32_t& buttons) noexcept;

}  // namespace limpid
