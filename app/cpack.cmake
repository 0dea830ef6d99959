# When a package is made: the version that was built, and its commit's time for all that is packed.
include(${CPACK_LIMPID_BUILD}/version/version.cmake)
set(CPACK_DEBIAN_PACKAGE_VERSION ${limpid_version})
# Program and library find scenes, arms and helpers in the same place.
set(whole_version ${limpid_version}-${CPACK_DEBIAN_PACKAGE_RELEASE})
set(limpid_common "limpid-common (= ${whole_version})")
string(APPEND CPACK_DEBIAN_UNSPECIFIED_PACKAGE_DEPENDS ", ${limpid_common}")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS ${limpid_common})
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
  "${CPACK_DEBIAN_LIBRARY_PACKAGE_NAME} (= ${whole_version}), ${limpid_common}")
# Files of it were in the package of the program before.
set(CPACK_DEBIAN_COMMON_PACKAGE_BREAKS "limpid (<< ${whole_version})")
set(CPACK_DEBIAN_COMMON_PACKAGE_REPLACES ${CPACK_DEBIAN_COMMON_PACKAGE_BREAKS})
if("$ENV{SOURCE_DATE_EPOCH}" STREQUAL "")
  set(ENV{SOURCE_DATE_EPOCH} ${limpid_epoch})
endif()
