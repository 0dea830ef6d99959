// Dialog that asks what to export, where to, how large and in which colours.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/stage/stage.h"

namespace limpid {

struct ExportOrder {
  enum class What : std::uint8_t { plot, figure, table, window, video };
  enum class Format : std::uint8_t { png, svg, pdf };

  What what = What::plot;
  std::size_t plot = 0;
  bool stretch = true;  // only the selected stretch of time, if there is one
  Format format = Format::png;
  double width = 160, height = 80;  // of each plot when printed [mm]
  int dpi = 300;                    // of the pixels
  Theme theme = Theme::light;
  std::filesystem::path file = {};
};

// Returns why a file of this order cannot have that name, by its ending; empty if it can.
std::string wrong_ending(const ExportOrder& order, const std::filesystem::path& file);

// Factor from printed sizes to those of the layout, whose text is 9 points high.
inline constexpr double kLayoutPerMillimetre = 96 / 25.4;  // [px/mm]

class ExportDialog {
 public:
  // Draws the dialog while `open`; returns the order once it is given. `plot`: the stage's plot
  // offered first; `folder`: default folder of files; `recorded`: there is a session to film.
  std::optional<ExportOrder> draw(bool& open, const Stage& stage, std::size_t plot,
                                  const std::filesystem::path& folder, bool recorded);

 private:
  void draw_what(const Stage& stage, bool recorded);
  void draw_stretch(const Stage& stage);
  void draw_size(std::size_t plots);
  std::string why_not() const;

  ExportOrder order_;
  std::string file_;     // as typed
  std::string offered_;  // name offered last; the user has typed another if file_ differs
  std::filesystem::path replaces_;
  bool was_open_ = false;
};

}  // namespace limpid
