// Device and proxy in contact: what the coordination experiments look at.
#pragma once

#include <string>

#include "app/experiments/signals.h"

namespace limpid {

// |f2| at row k [N m].
double contact_torque(const Session& s, std::size_t k);
// Least-squares slope of |x_E| on |f2| in contact, through the origin [rad/(N m)].
double contact_slope(const Session& s);
// Contacts that last and that some time without contact precedes.
int lasting_contacts(const Session& s);

Series error_over_time(const Session& s, const std::string& label, const char* color);
// |x_E| [mrad] against |f2|, with the slope.
void add_contact_scatter(FigurePanel& panel, const Session& s, const std::string& label,
                         const char* color);

}  // namespace limpid
