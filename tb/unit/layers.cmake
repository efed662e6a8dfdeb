# SPDX-License-Identifier: MIT
foreach(check layers links format)
  add_test(NAME ${check}
           COMMAND ${PROJECT_SOURCE_DIR}/tb/unit/${check}_test.py ${PROJECT_SOURCE_DIR})
  set_tests_properties(${check} PROPERTIES LABELS unit SKIP_REGULAR_EXPRESSION "^skipped")
endforeach()
