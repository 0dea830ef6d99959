// What there is to read: the window behind it goes on.
#pragma once

namespace limpid {

// While `open`; closing it clears that.
void draw_help(bool& open);
void draw_about(bool& open);

}  // namespace limpid
