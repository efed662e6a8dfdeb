# SPDX-License-Identifier: MIT
# Mesa as an oracle: optional at build time (headers) and at run time (a software device).
pkg_check_modules(PC_OracleEgl QUIET IMPORTED_TARGET egl glesv2)
if(PC_OracleEgl_FOUND)
  deburr_library(mesa LAYER tb
    SOURCES "${CMAKE_CURRENT_LIST_DIR}/mesa_device.cpp"
    LINK deburr::conformance
    PRIVATE_LINK PkgConfig::PC_OracleEgl)
  deburr_test(mesa_test PROGRAM oracle_mesa_tests LABELS oracle
    SOURCE "${CMAKE_CURRENT_LIST_DIR}/mesa_test.cpp"
    LINK deburr::mesa)
else()
  add_test(NAME mesa_test.absent COMMAND "${CMAKE_COMMAND}" -E echo
           "skipped: the headers of EGL and OpenGL ES are absent (scripts/install oracle)")
  set_tests_properties(mesa_test.absent PROPERTIES LABELS oracle SKIP_REGULAR_EXPRESSION "^skipped")
endif()
