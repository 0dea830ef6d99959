// Embree as on a processor with SSE2 only; loaded before the program (LD_PRELOAD).
#include <dlfcn.h>

#include <string>

#include "core/touch/embree.h"

extern "C" RTCDevice rtcNewDevice(const char* config) {
  using Make = RTCDevice (*)(const char*);
  static const auto make = reinterpret_cast<Make>(dlsym(RTLD_NEXT, "rtcNewDevice"));
  return make((std::string(config == nullptr ? "" : config) + ",isa=sse2,verbose=1").c_str());
}
