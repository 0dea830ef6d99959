# When a package is made: the version that was built, and its commit's time for all that is packed.
include(${CPACK_LIMPID_BUILD}/version/version.cmake)
set(CPACK_DEBIAN_PACKAGE_VERSION ${limpid_version})
if("$ENV{SOURCE_DATE_EPOCH}" STREQUAL "")
  set(ENV{SOURCE_DATE_EPOCH} ${limpid_epoch})
endif()
