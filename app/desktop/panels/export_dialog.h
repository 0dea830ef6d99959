// Asks what is to be taken away, where to, how large and in which colours.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/desktop/base/stage.h"

namespace limpid {

struct ExportOrder {
  enum class What : std::uint8_t { plot, table, window, video };
  enum class Format : std::uint8_t { png, svg };

  What what = What::plot;
  std::size_t plot = 0;
  Format format = Format::png;
  double width = 160, height = 80;  // printed [mm]
  int dpi = 300;                    // of pixels
  Theme theme = Theme::light;
  std::filesystem::path file = {};
};

// What stands between the sizes that are printed and the layout's, whose text is 9 points high.
inline constexpr double kLayoutPerMillimetre = 96 / 25.4;  // [px/mm]

class ExportDialog {
 public:
  // While `open`. `plot`: which of the stage's is offered first; `folder`: where files go;
  // `recorded`: there is a session that can be filmed. The order once it is given.
  std::optional<ExportOrder> draw(bool& open, const Stage& stage, std::size_t plot,
                                  const std::filesystem::path& folder, bool recorded);

 private:
  void draw_what(const Stage& stage, bool recorded);
  void draw_size();
  std::string why_not() const;

  ExportOrder order_;
  std::string file_;     // as it is typed
  std::string offered_;  // that stood there, as long as nobody has typed
  std::filesystem::path replaces_;
  bool was_open_ = false;
};

}  // namespace limpid
