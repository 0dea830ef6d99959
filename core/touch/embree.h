// Embree 3 or 4, whichever is there: what is asked of it is the same in both.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
