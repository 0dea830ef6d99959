// Loaded before the program (LD_PRELOAD): Embree as it is on a processor that has SSE2 and no more.
#include <dlfcn.h>

#include <string>

#include "core/touch/embree.h"

extern "C" RTCDevice rtcNewDevice(const char* config) {
  using Make = RTCDevice (*)(const char*);
  static const auto make = reinterpret_cast<Make>(dlsym(RTLD_NEXT, "rtcNewDevice"));
  return make((std::string(config == nullptr ? "" : config) + ",isa=sse2,verbose=1").c_str());
}
