// Rotations of a URDF, the same to the last bit on every processor.
#pragma once

#include <urdf_model/model.h>

class TiXmlElement;

namespace limpid {

// urdfdom asks the system's mathematical library for them (see core/math/elementary.h): those of
// joints and of centres of mass are put into the model once more.
void set_turns(const TiXmlElement& robot, urdf::ModelInterface& model);

}  // namespace limpid
