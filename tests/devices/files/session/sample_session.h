// A session with a different number in every place, so that no two can be confused.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "devices/files/session/session.h"

namespace limpid::test {

inline SessionInfo sample_info(int dof = 3) {
  SessionInfo info;
  info.tick = 0.001;
  info.dof = dof;
  info.created = "2024-02-29T12:00:00Z";
  info.app_version = "1.2.3";
  info.seed = 0xFFFF'FFFF'FFFF'FFFFull;
  info.source = "a hand, \xCE\xB7";
  info.config = "coupling.eta = 0.6\n";
  info.safety = "speed = 2.0\n";
  info.device_urdf = std::string(200000, 'u') + "end";
  info.scene = "title = \"T\"\n";
  const std::vector<unsigned char> model{'g', 'l', 'T', 'F', 0, 255};
  info.models["a \xCE\xB7.glb"] = std::make_shared<const std::vector<unsigned char>>(model);
  return info;
}

// Rows from k = `from` on, at t = k * tick. The other numbers are noise that depends on k and place
// alone; for two thirds of the time nothing is touched.
inline std::vector<double> sample_rows(const RowLayout& layout, std::size_t from,
                                       std::size_t count) {
  std::vector<double> rows;
  for (std::size_t k = from; k < from + count; ++k) {
    for (int i = 0; i < layout.stride(); ++i) {
      std::uint64_t bits = k * 1000003 + static_cast<std::uint64_t>(i);
      bits = (bits ^ (bits >> 31)) * 0x7fb5d329728ea185ull;
      bits = (bits ^ (bits >> 27)) * 0x81dadef4bc2dd44dull;
      rows.push_back(static_cast<double>(bits >> 11) * 0x1p-53 - 0.5);
    }
    const std::span<double> row = std::span(rows).last(static_cast<std::size_t>(layout.stride()));
    if (k / 700 % 3 != 1) {
      for (const Column c : {Column::contact_point, Column::contact_force}) {
        std::ranges::fill(layout.in(row, c), 0.0);
      }
    }
    layout.in(row, Column::time)[0] = static_cast<double>(k) * 0.001;
    layout.in(row, Column::kind)[0] = static_cast<double>(k % 2);
    layout.in(row, Column::force_wanted)[0] = static_cast<double>(k / 2 % 2);
    layout.in(row, Column::force_state)[0] = static_cast<double>(k % 10);
    layout.in(row, Column::hand_grip)[0] = static_cast<double>(k / 3 % 2);
    if (layout.has(Column::hand_magnet)) {
      layout.in(row, Column::hand_magnet)[0] = static_cast<double>(k / 4 % 2);
      layout.in(row, Column::hand_pull)[0] = static_cast<double>(k / 6 % 3);
    }
    layout.in(row, Column::solved)[0] = static_cast<double>(k / 5 % 4);
  }
  return rows;
}

inline void write_sample(const std::filesystem::path& out, std::size_t rows, int dof = 3) {
  SessionWriter writer(out, sample_info(dof), false);
  writer.append(sample_rows(RowLayout(dof), 0, rows));
  writer.append(SettingChange{3, "coupling.k_vc = 8"});
  writer.close();
}

}  // namespace limpid::test
