# SPDX-License-Identifier: MIT
# `cpack -G DEB`: the packages deburr (the program), libdeburr-dev (libraries and headers) and python3-deburr. Of the preset
# `package`, so that no path of the machine that built them stands in them.
file(READ "${PROJECT_SOURCE_DIR}/LICENSE" license)
string(REGEX REPLACE "^MIT License\n\nCopyright \\(c\\) ([^\n]*)\n\n" "" text "${license}")
set(holder "${CMAKE_MATCH_1}")
string(REGEX REPLACE "\n\n" "\n.\n" text "${text}")
string(REGEX REPLACE "\n(.)" "\n \\1" text "${text}")
set(copyright "${PROJECT_BINARY_DIR}/installed/copyright")
file(CONFIGURE OUTPUT "${copyright}" @ONLY CONTENT
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: Deburr

Files: *
Copyright: @holder@
License: MIT
 @text@")
set(changelog "${PROJECT_BINARY_DIR}/installed/changelog.gz")
add_custom_command(OUTPUT "${changelog}"
  COMMAND gzip -9nc "${PROJECT_SOURCE_DIR}/CHANGELOG.md" > "${changelog}"
  DEPENDS "${PROJECT_SOURCE_DIR}/CHANGELOG.md")
add_custom_target(deburr_changelog ALL DEPENDS "${changelog}")
add_dependencies(deburr_installed deburr_changelog)
install(FILES "${copyright}" "${changelog}" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/libdeburr-dev"
  COMPONENT development)
if(DEBURR_PROGRAM)
  install(FILES "${copyright}" "${changelog}" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/deburr" COMPONENT program)
endif()
if(TARGET deburr_python)
  install(FILES "${copyright}" "${changelog}" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/python3-deburr"
    COMPONENT python)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME deburr)
set(CPACK_PACKAGE_VENDOR "The Deburr developers")
set(CPACK_PACKAGE_CONTACT "The Deburr developers <deburr@localhost>")
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION electronics)
set(CPACK_COMPONENTS_ALL development)
if(DEBURR_PROGRAM)
  list(PREPEND CPACK_COMPONENTS_ALL program)
endif()
if(TARGET deburr_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Cycle-accurate models of anti-aliasing hardware
 Runs SystemC models of a texture unit and of anti-aliasing engines on scenes
 and frames, checks each against a bit-exact golden model, and reports clocks,
 stalls, traffic and image quality.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME deburr)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Models of anti-aliasing hardware, libraries
 Golden models in C++20 and SystemC models of a texture unit and of
 anti-aliasing engines, with drivers, hosts and a memory for a platform of
 one's own.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libdeburr-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libsystemc-dev, libfmt-dev")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Models of anti-aliasing hardware, Python module
 Golden models of a texture unit and of anti-aliasing engines, reference
 filters and truth as functions on numpy arrays; runs and sweeps of their
 SystemC models as arrays and tables.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-deburr)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
if(TARGET deburr_python)
  # It is of the Python that it was compiled for.
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "deburr (= ${PROJECT_VERSION}), python3-numpy, \
python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}~), python3 (<< ${Python_VERSION_MAJOR}.${next})")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-pandas, ninja-build")
include(CPack)
