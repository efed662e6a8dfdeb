# SPDX-License-Identifier: MIT
foreach(class Registers Blind)
  add_test(NAME frame_negative.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/frame_test.py" -v ${class})
  list(APPEND FRAME_NEGATIVE_TESTS frame_negative.${class})
endforeach()
set_tests_properties(${FRAME_NEGATIVE_TESTS} PROPERTIES
  LABELS negative TIMEOUT 300 ENVIRONMENT "DEBURR=$<TARGET_FILE:deburr>;PYTHONDONTWRITEBYTECODE=1")
