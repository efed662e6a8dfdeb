# SPDX-License-Identifier: MIT
# Mesa as an oracle: optional at build time (headers) and at run time (a software device).
pkg_check_modules(PC_OracleEgl QUIET IMPORTED_TARGET egl glesv2)
if(PC_OracleEgl_FOUND)
  deburr_library(mesa LAYER tb
    SOURCES
      "${CMAKE_CURRENT_LIST_DIR}/mesa_context.cpp"
      "${CMAKE_CURRENT_LIST_DIR}/mesa_device.cpp"
      "${CMAKE_CURRENT_LIST_DIR}/smaa_shader.cpp"
    LINK deburr::conformance deburr::scene
    PRIVATE_LINK PkgConfig::PC_OracleEgl)
  deburr_test(mesa_test PROGRAM oracle_mesa_tests LABELS oracle
    SOURCE "${CMAKE_CURRENT_LIST_DIR}/mesa_test.cpp"
    LINK deburr::mesa)
  deburr_test(mesa_blocks_test PROGRAM oracle_mesa_tests LABELS oracle
    SOURCE "${CMAKE_CURRENT_LIST_DIR}/mesa_blocks_test.cpp"
    LINK deburr::mesa PkgConfig::PC_OracleEgl)
  deburr_test(smaa_shader_test PROGRAM oracle_mesa_tests LABELS oracle TIMEOUT 300
    LONG PublishedShader[.]WeightsAreCloseAtOtherSizesForEveryQuality
    SOURCE "${CMAKE_CURRENT_LIST_DIR}/smaa_shader_test.cpp"
    LINK deburr::mesa deburr::golden_morphological deburr::ideal deburr::scene deburr::stimuli)
else()
  foreach(test mesa_test mesa_blocks_test smaa_shader_test)
    add_test(NAME ${test}.absent COMMAND "${CMAKE_COMMAND}" -E echo
             "skipped: the headers of EGL and OpenGL ES are absent (scripts/install oracle)")
    set_tests_properties(${test}.absent PROPERTIES LABELS oracle SKIP_REGULAR_EXPRESSION "^skipped")
  endforeach()
endif()
