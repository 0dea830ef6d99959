# What is installed beside the programs, and the .deb of it all: `cpack` in the build folder.
set(desktop ${PROJECT_SOURCE_DIR}/assets/desktop)
set(package ${PROJECT_SOURCE_DIR}/assets/package)

# Builds all that is installed; the target limpid is the program alone.
add_custom_target(installed)
add_dependencies(installed limpid liblimpid)
if(TARGET limpid_loop)
  add_dependencies(installed limpid_loop)
endif()

# The manual has the READMEs of sweeps and stories, with pictures that are not beside them here.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/assets ${PROJECT_SOURCE_DIR}/shaders
  DESTINATION share/limpid
  REGEX "/assets/(completions|desktop|package|pictures|python)$" EXCLUDE
  REGEX "/assets/(devices|hands|scenes)$" EXCLUDE
  REGEX "/assets/(stories|sweeps)/README.md$" EXCLUDE
  PATTERN "*.py" EXCLUDE
  PATTERN "__pycache__" EXCLUDE)
# The library needs these as well, and the programs that read sessions and models.
set(common ${PROJECT_SOURCE_DIR}/assets)
install(DIRECTORY ${common}/devices ${common}/hands ${common}/scenes
  DESTINATION share/limpid/assets COMPONENT common
  PATTERN "*.py" EXCLUDE
  PATTERN "__pycache__" EXCLUDE)
install(FILES ${package}/copyright DESTINATION share/doc/limpid-common COMPONENT common)
install(CODE "set(SOURCE \"${PROJECT_SOURCE_DIR}\")\nset(BUILD \"${PROJECT_BINARY_DIR}\")
include(\${SOURCE}/app/install_changes.cmake)
pack_changes(limpid-common)" COMPONENT common)
install(DIRECTORY ${PROJECT_BINARY_DIR}/made/icons DESTINATION share)  # see app/CMakeLists.txt
install(FILES ${desktop}/limpid.desktop DESTINATION share/applications)
install(FILES ${desktop}/limpid.xml DESTINATION share/mime/packages)
install(FILES ${desktop}/org.limpid.limpid.metainfo.xml DESTINATION share/metainfo)
install(FILES ${PROJECT_SOURCE_DIR}/assets/completions/limpid.bash
  DESTINATION share/bash-completion/completions RENAME limpid)
install(FILES ${PROJECT_SOURCE_DIR}/assets/completions/_limpid
  DESTINATION share/zsh/vendor-completions)
install(FILES ${PROJECT_SOURCE_DIR}/assets/completions/limpid.fish
  DESTINATION share/fish/vendor_completions.d)
install(FILES ${package}/copyright ${PROJECT_BINARY_DIR}/made/manual.html
  DESTINATION share/doc/limpid)
install(FILES ${PROJECT_SOURCE_DIR}/assets/python/limpid_device.py
  ${PROJECT_SOURCE_DIR}/assets/python/read_session.py ${PROJECT_SOURCE_DIR}/assets/python/ros2_node.py
  ${PROJECT_SOURCE_DIR}/assets/python/touch_env.py DESTINATION share/doc/limpid/examples)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/assets/python/lessons
  DESTINATION share/doc/limpid/examples PATTERN "__pycache__" EXCLUDE)
install(CODE "set(SOURCE \"${PROJECT_SOURCE_DIR}\")\nset(BUILD \"${PROJECT_BINARY_DIR}\")")
install(SCRIPT ${CMAKE_CURRENT_LIST_DIR}/install.cmake)

set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # what is installed is the program, not the tests
set(CPACK_GENERATOR DEB)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/cpack.cmake)
set(CPACK_LIMPID_BUILD ${PROJECT_BINARY_DIR})
set(CPACK_PACKAGE_NAME limpid)
set(CPACK_PACKAGE_CONTACT "The Limpid authors <maintainers@limpid.invalid>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/cpack_folders.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
# A package is of one release of Debian, whose libraries have other names in the next one. One of
# Debian's own would be newer.
cmake_host_system_information(RESULT distribution QUERY DISTRIB_INFO)
set(CPACK_DEBIAN_PACKAGE_RELEASE 0limpid1~${distribution_ID}${distribution_VERSION_ID})
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_DEPENDS "adduser, fonts-inter, libegl1, libgl1")
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_RECOMMENDS "gnuplot-nox | gnuplot, libgl1-mesa-dri, rtkit")
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_SUGGESTS
  "python3, python3-h5py, python3-numpy, python3-scipy, xdg-desktop-portal")
set(CPACK_DEBIAN_UNSPECIFIED_DESCRIPTION "touch a virtual world through a haptic device
A haptic device, a small robot arm in the hand, is tied to its avatar in a
simulated world by a virtual coupling. Limpid runs the usual spring and
damper, a coupling with a human force observer, and a predictive one, live at
1 kHz, and shows tick by tick how transparent each of them is.

It works with the mouse alone, and with joysticks that have force feedback,
the SpaceMouse, and home-made devices. Sessions are recorded, played, run
again under other settings and made videos; experiments and sweeps run
without a window.")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_CONTROL_EXTRA
  ${package}/postinst ${package}/postrm ${package}/conffiles)
# Four packages: the program, the library, what both need, and what other programs are built with
# it by.
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL Unspecified common library dev)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME limpid)
set(CPACK_DEBIAN_COMMON_PACKAGE_NAME limpid-common)
set(CPACK_DEBIAN_COMMON_DESCRIPTION "arms, scenes and readers of files for Limpid
Arms and scenes that come with Limpid and with its library, recorded hands, and
the programs that read sessions and models for both.")
set(limpid_library_package liblimpid${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${limpid_library_package})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${package}/triggers)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "haptic loop with virtual couplings, as a library
The tick of Limpid's loop for programs that have a device or a simulation of
their own: an arm, a scene and a coupling law in, torques out, with the limits
and the arming of the application.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME liblimpid-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_DESCRIPTION "header and examples of Limpid's haptic loop
What is needed to build programs with liblimpid: one header, packages for
CMake and pkg-config, and examples to start from.")
include(CPack)
