# SPDX-License-Identifier: MIT
# `cpack -G DEB`: the packages deburr (the program), libdeburr-dev (libraries and headers) and python3-deburr. They
# are built with the preset `package`, so that they contain no path of the build machine.
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
set(contact "The Deburr developers <deburr@localhost>")
set(release 1)
string(TIMESTAMP today "%a, %d %b %Y 00:00:00 +0000" UTC)
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/installed/changelog.Debian" @ONLY CONTENT
"deburr (@PROJECT_VERSION@-@release@) unstable; urgency=medium

  * Made by cpack. What has changed is in changelog.gz.

 -- @contact@  @today@
")
# deburr_compressed(<variable> <file> <source>): compressed as Debian requires below share/doc and share/man.
function(deburr_compressed variable file source)
  set(output "${PROJECT_BINARY_DIR}/installed/${file}.gz")
  add_custom_command(OUTPUT "${output}" COMMAND gzip -9nc "${source}" > "${output}" DEPENDS "${source}" VERBATIM)
  list(APPEND ${variable} "${output}")
  set(${variable} "${${variable}}" PARENT_SCOPE)
endfunction()
set(documents "${copyright}")
deburr_compressed(documents changelog "${PROJECT_SOURCE_DIR}/CHANGELOG.md")
deburr_compressed(documents changelog.Debian "${PROJECT_BINARY_DIR}/installed/changelog.Debian")
set(manual "")
if(DEBURR_PROGRAM)
  deburr_compressed(manual deburr.1 "${PROJECT_BINARY_DIR}/installed/deburr.1")
  install(FILES "${manual}" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT program)
endif()
add_custom_target(deburr_documents ALL DEPENDS ${documents} ${manual})
add_dependencies(deburr_installed deburr_documents)

# deburr_package(<component> <package>): files that every package has in addition to its own.
set(CPACK_COMPONENTS_ALL "")
macro(deburr_package component package)
  install(FILES ${documents} DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${package}" COMPONENT ${component})
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/installed/lintian/${package}" @ONLY CONTENT
"# Whoever builds the packages gives them to others; the project has no address for mail.
${package}: bogus-mail-host Maintainer *
${package}: bogus-mail-host-in-debian-changelog *
# They are not in Debian's archive, where a bug would ask for them.
${package}: initial-upload-closes-no-bugs *
")
  install(FILES "${PROJECT_BINARY_DIR}/installed/lintian/${package}"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/lintian/overrides" COMPONENT ${component})
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  string(TOUPPER ${component} name)
  set(CPACK_DEBIAN_${name}_PACKAGE_NAME ${package})
endmacro()
if(DEBURR_PROGRAM)
  deburr_package(program deburr)
endif()
deburr_package(development libdeburr-dev)
if(TARGET deburr_python)
  deburr_package(python python3-deburr)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME deburr)
set(CPACK_PACKAGE_VENDOR "The Deburr developers")
set(CPACK_PACKAGE_CONTACT "${contact}")
set(CPACK_DEBIAN_PACKAGE_SOURCE deburr)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${release})
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION electronics)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Cycle-accurate models of anti-aliasing hardware
 Runs SystemC models of a texture unit and of anti-aliasing engines on scenes
 and frames, checks each against a bit-exact golden model, and reports cycles,
 stalls, traffic and image quality.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Models of anti-aliasing hardware, libraries
 Golden models in C++20 and SystemC models of a texture unit and of
 anti-aliasing engines, with drivers, hosts and a memory for a platform of
 one's own.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libsystemc-dev, libfmt-dev")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Models of anti-aliasing hardware, Python module
 Golden models of a texture unit and of anti-aliasing engines, reference
 filters and reference as functions on numpy arrays; runs and sweeps of their
 SystemC models as arrays and tables.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
if(TARGET deburr_python)
  # Depends on the Python version it was compiled for.
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "deburr (= ${PROJECT_VERSION}-${release}), python3-numpy, \
python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}~), python3 (<< ${Python_VERSION_MAJOR}.${next})")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-pandas, ninja-build")
include(CPack)
