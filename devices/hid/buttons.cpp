#include "devices/hid/buttons.h"

#include "devices/hid/report_fields.h"

namespace limpid {
namespace {

constexpr Usage kFirst = make_usage(0x09, 1);
constexpr Usage kLast = make_usage(0x09, 32);

}  // namespace

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
                    std::uint32_t& buttons) noexcept {
  bool any = false;
  for (const ReportField& field : fields) {
    if (report.empty() || report[0] != field.report_id) continue;
    const auto pressed = get_field(report, field);
    if (!pressed) continue;
    const std::uint32_t bit = 1u << (field.usages[0] - kFirst);
    buttons = *pressed ? buttons | bit : buttons & ~bit;
    any = true;
  }
  return any;
}

}  // namespace limpid
