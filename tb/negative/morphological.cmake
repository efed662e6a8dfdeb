# SPDX-License-Identifier: MIT
foreach(class Frames Configuration Faults SharesFaults GuardFaults SmaaFaults)
  add_test(NAME morphological_negative.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/morphological_test.py" -v ${class})
  list(APPEND MORPHOLOGICAL_NEGATIVE_TESTS morphological_negative.${class})
endforeach()
set_tests_properties(${MORPHOLOGICAL_NEGATIVE_TESTS} PROPERTIES
  LABELS negative TIMEOUT 300 ENVIRONMENT "DEBURR=$<TARGET_FILE:deburr>;PYTHONDONTWRITEBYTECODE=1")
