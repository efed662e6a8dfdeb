# SPDX-License-Identifier: MIT
# Labels of ctest; scripts/test reads them from this file. The target deburr_LABEL_tests builds only what the tests of
# a label run.
set(DEBURR_LABELS smoke unit timing system stress oracle negative perf tools examples long slurm fuzz hdl formal)
foreach(label ${DEBURR_LABELS})
  add_custom_target(deburr_${label}_tests)
endforeach()
