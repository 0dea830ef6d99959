// Editor of an object that moves, and of the springs between such objects.
#pragma once

#include <string_view>

#include "app/desktop/scene/document.h"

namespace limpid {

// Edits whether an object moves, and its body. Returns the name of the change, "" for none.
std::string edit_body(Object& object, const Scene& scene, std::size_t place);

// Edits springs and gravity of a scene with moving objects; draws nothing for others.
void draw_springs(Document& document);

}  // namespace limpid
