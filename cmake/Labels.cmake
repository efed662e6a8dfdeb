# SPDX-License-Identifier: MIT
# The labels of ctest, which scripts/test reads here. The target deburr_LABEL_tests builds what the tests
# of a label run, and no more.
set(DEBURR_LABELS smoke unit timing system stress oracle negative perf tools examples long slurm fuzz hdl formal)
foreach(label ${DEBURR_LABELS})
  add_custom_target(deburr_${label}_tests)
endforeach()
