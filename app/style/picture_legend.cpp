#include "app/style/picture_legend.h"

#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {

void draw_picture_legend(ImDrawList& list, ImVec2 at) {
  ImFont* small = font(Face::small);
  const float em = small->FontSize;
  const Palette& colours = current_palette();
  struct Entry {
    const char* text;
    Ink ink;
  };
  for (const Entry& entry :
       {Entry{"device (ghost)", Ink::device}, Entry{"proxy", Ink::proxy}, Entry{"hand", Ink::hand},
        Entry{"contact force, 1 N = 2 cm", Ink::contact}}) {
    list.AddCircleFilled({at.x + em * 0.3f, at.y + em * 0.55f}, em * 0.3f,
                         colour(ink(colours, entry.ink)));
    list.AddText(small, em, {at.x + em, at.y}, colour(colours.text, 0.85f), entry.text);
    at.y += 1.35f * em;
  }
}

}  // namespace limpid
