# When a package is made: the version that was built, and its commit's time for all that is packed.
include(${CPACK_LIMPID_BUILD}/version/version.cmake)
set(CPACK_DEBIAN_PACKAGE_VERSION ${limpid_version})
# The library finds scenes, arms and helpers where the program has them.
set(whole_version ${limpid_version}-${CPACK_DEBIAN_PACKAGE_RELEASE})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "limpid (= ${whole_version})")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
  "${CPACK_DEBIAN_LIBRARY_PACKAGE_NAME} (= ${whole_version}), limpid (= ${whole_version})")
if("$ENV{SOURCE_DATE_EPOCH}" STREQUAL "")
  set(ENV{SOURCE_DATE_EPOCH} ${limpid_epoch})
endif()
