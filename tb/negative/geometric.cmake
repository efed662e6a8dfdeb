# SPDX-License-Identifier: MIT
foreach(class Meshes Configuration Faults Registers Blind)
  add_test(NAME geometric_negative.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/geometric_test.py" -v ${class})
  list(APPEND GEOMETRIC_NEGATIVE_TESTS geometric_negative.${class})
endforeach()
set_tests_properties(${GEOMETRIC_NEGATIVE_TESTS} PROPERTIES
  LABELS negative TIMEOUT 300 ENVIRONMENT "DEBURR=$<TARGET_FILE:deburr>;PYTHONDONTWRITEBYTECODE=1")
