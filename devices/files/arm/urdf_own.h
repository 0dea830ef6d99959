// What a URDF says of an arm beyond its format, in elements <limpid> of the robot:
//
//     <limpid tip="LINK" gravity="0 0 -9.81" delay="0.002">
//       <spring joint="JOINT" stiffness="0.12" offset="0.01"/>
//     </limpid>
//
// gravity [m/s^2] in the base's frame, as the arm stands; delay [s] of the device that the arm was
// identified from; springs in N m/rad and N m, of slides in N/m and N: the joint is pulled by
// -(stiffness x + offset). Of what is said twice the last one holds.
#pragma once

#include <string>

#include "core/dynamics/arm_description.h"
#include "devices/files/arm/urdf_places.h"

class TiXmlElement;

namespace limpid {

// The link that it names as its tip; empty: none.
std::string own_tip(const TiXmlElement& robot);

// Everything else. Springs of joints that are not in the chain pull at nothing. Errors: FileError
// for what is no number or out of range, and joints that the robot does not have.
void read_own(const TiXmlElement& robot, const UrdfPlaces& places, ArmDescription& arm);

}  // namespace limpid
