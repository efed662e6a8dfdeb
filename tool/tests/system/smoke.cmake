# SPDX-License-Identifier: MIT
# Every engine runs with defaults on a small scene, and whole testplans pass.
add_dependencies(deburr_smoke_tests deburr)
foreach(engine ${DEBURR_ENGINES})
  add_test(NAME smoke_${engine}
           COMMAND deburr run ${engine} --size 96x96 --out ${CMAKE_CURRENT_BINARY_DIR}/smoke_${engine})
  set_tests_properties(smoke_${engine} PROPERTIES LABELS smoke TIMEOUT 60
                       PASS_REGULAR_EXPRESSION "RESULT: PASS" FAIL_REGULAR_EXPRESSION " 0 cycles")
endforeach()
# smoke.yaml in every ctest; coverage.yaml, which takes a minute, with the long tests.
foreach(plan IN ITEMS smoke coverage)
  add_test(NAME ${plan}_testplan
           COMMAND deburr regress tb/testplan/${plan}.yaml run --seed 1 --out ${CMAKE_CURRENT_BINARY_DIR}/${plan}_testplan
           WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(${plan}_testplan PROPERTIES LABELS smoke TIMEOUT 600)
endforeach()
set_property(TEST coverage_testplan APPEND PROPERTY LABELS long)
add_dependencies(deburr_long_tests deburr)
