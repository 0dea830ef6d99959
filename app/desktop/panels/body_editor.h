// What can be changed about an object that moves, and about the springs between such objects.
#pragma once

#include <string_view>

#include "app/desktop/document/document.h"

namespace limpid {

// Of the object at a place: whether it moves, and all that goes with it. Returns what was changed,
// "" for nothing.
std::string_view edit_body(Object& object, const Scene& scene, std::size_t place);

// The springs and gravity of a scene in which something moves; nothing of others.
void draw_springs(Document& document);

}  // namespace limpid
