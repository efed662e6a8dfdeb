# SPDX-License-Identifier: MIT
# OpenImageIO's texture system as a second oracle. Debian's CMake package needs OpenCV's headers; its pkg-config file
# does not.
pkg_check_modules(PC_OracleOpenImageIO QUIET IMPORTED_TARGET OpenImageIO)
if(PC_OracleOpenImageIO_FOUND)
  set(oracle_openimageio PkgConfig::PC_OracleOpenImageIO)
else()
  deburr_find_package(OpenImageIO libopenimageio-dev)
  set(oracle_openimageio OpenImageIO::OpenImageIO)
endif()
deburr_test(openimageio_test PROGRAM oracle_openimageio_tests LABELS oracle
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/openimageio_test.cpp"
  LINK deburr::conformance ${oracle_openimageio})
