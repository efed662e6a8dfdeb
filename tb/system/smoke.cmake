# SPDX-License-Identifier: MIT
# Does every engine run with defaults on a small scene?
add_dependencies(deburr_smoke_tests deburr)
foreach(engine ${DEBURR_ENGINES})
  add_test(NAME smoke_${engine}
           COMMAND deburr run ${engine} --size 96x96 --out ${CMAKE_CURRENT_BINARY_DIR}/smoke_${engine})
  set_tests_properties(smoke_${engine} PROPERTIES LABELS smoke TIMEOUT 60
                       PASS_REGULAR_EXPRESSION "RESULT: PASS" FAIL_REGULAR_EXPRESSION " 0 cycles")
endforeach()
add_test(NAME smoke_testplan
         COMMAND deburr regress tb/testplan/smoke.yaml run --seed 1 --out ${CMAKE_CURRENT_BINARY_DIR}/smoke_testplan
         WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(smoke_testplan PROPERTIES LABELS smoke TIMEOUT 600)
