// Makers of devices with a library of their own. A further one is a line here, a file in
// devices/vendor, and its arm.
//
// EACH(KEY, NAME, MAKER, NUMBERS...): KEY as in ids of devices, KEY:NAME_OF_DEVICE; the function
// make_KEY() of the program limpid-vendor makes its back end, and assets/devices/KEY.urdf is its
// arm. NAME and MAKER are for people; NUMBERS are those of the maker as a vendor on USB. Limpid and
// limpid-vendor make their own tables of this list, as neither has the other's code.
#pragma once

#define LIMPID_VENDORS(EACH)                             \
  EACH(openhaptics, "OpenHaptics", "3D Systems", 0x2988) \
  EACH(forcedimension, "Force Dimension", "Force Dimension", 0x1451)
