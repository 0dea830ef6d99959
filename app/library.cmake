# liblimpid, and what other programs need to be built with it: the package limpid of CMake and
# pkg-config. Nothing is seen of it but what its header names.
add_library(liblimpid SHARED $<TARGET_OBJECTS:limpid_app_library>)
set_target_properties(liblimpid PROPERTIES
  OUTPUT_NAME limpid EXPORT_NAME limpid LINKER_LANGUAGE CXX
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_compile_features(liblimpid INTERFACE cxx_std_20)
target_include_directories(liblimpid INTERFACE
  $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/library> $<INSTALL_INTERFACE:include>)
target_link_libraries(liblimpid PRIVATE limpid_app_run)
target_link_options(liblimpid PRIVATE -Wl,--exclude-libs,ALL -Wl,--as-needed)
add_dependencies(liblimpid limpid-session limpid-model)

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(limpid_package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/limpid)
install(TARGETS liblimpid EXPORT limpid
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT dev)
install(FILES library/limpid/limpid.h DESTINATION include/limpid COMPONENT dev)
install(EXPORT limpid NAMESPACE limpid:: FILE limpidTargets.cmake
  DESTINATION ${limpid_package_folder} COMPONENT dev)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/limpidConfig.cmake @ONLY CONTENT [[
include(${CMAKE_CURRENT_LIST_DIR}/limpidTargets.cmake)
]])
write_basic_package_version_file(${PROJECT_BINARY_DIR}/limpidConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
file(RELATIVE_PATH limpid_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/limpid.pc @ONLY CONTENT [[
prefix=${pcfiledir}/@limpid_prefix@
libdir=${prefix}/@CMAKE_INSTALL_LIBDIR@
Name: limpid
Description: haptic loop with virtual couplings
Version: @PROJECT_VERSION@
Cflags: -I${prefix}/include
Libs: -L${libdir} -llimpid
]])
install(FILES ${PROJECT_BINARY_DIR}/limpidConfig.cmake ${PROJECT_BINARY_DIR}/limpidConfigVersion.cmake
  DESTINATION ${limpid_package_folder} COMPONENT dev)
install(FILES ${PROJECT_BINARY_DIR}/limpid.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT dev)
install(DIRECTORY library/examples/ DESTINATION share/doc/limpid/examples/library COMPONENT dev)
# Packages of the library have the licence and changes of what they depend on.
file(CREATE_LINK limpid-common ${PROJECT_BINARY_DIR}/doc_of_limpid SYMBOLIC)
install(FILES ${PROJECT_BINARY_DIR}/doc_of_limpid DESTINATION share/doc RENAME liblimpid-dev
  COMPONENT dev)
install(FILES ${PROJECT_BINARY_DIR}/doc_of_limpid DESTINATION share/doc
  RENAME liblimpid${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} COMPONENT library)

# Python's module stands by itself, so that it goes wherever the package goes.
find_program(Python_EXECUTABLE NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_package(Python COMPONENTS Interpreter Development.Module QUIET)
find_package(pybind11 CONFIG QUIET)
if(pybind11_FOUND AND Python_FOUND)
  pybind11_add_module(limpid_loop MODULE NO_EXTRAS library/python/loop_module.cpp
    $<TARGET_OBJECTS:limpid_app_library>)
  set_target_properties(limpid_loop PROPERTIES OUTPUT_NAME _loop)
  target_include_directories(limpid_loop PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/library
    ${PROJECT_SOURCE_DIR})
  target_link_libraries(limpid_loop PRIVATE limpid_app_run)
  target_link_options(limpid_loop PRIVATE -Wl,--exclude-libs,ALL -Wl,--as-needed)
  file(WRITE ${PROJECT_BINARY_DIR}/python_module.cmake
    "set(python_module ${CMAKE_CURRENT_BINARY_DIR}/_loop${PYTHON_MODULE_EXTENSION})\n")
else()
  message(STATUS "No pybind11 or headers of Python: limpid.Loop is left out")
  file(WRITE ${PROJECT_BINARY_DIR}/python_module.cmake "set(python_module)\n")
endif()
