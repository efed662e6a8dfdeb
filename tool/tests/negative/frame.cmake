# SPDX-License-Identifier: MIT
deburr_script_test(frame_negative FILE frame LABELS negative ENVIRONMENT DEBURR=$<TARGET_FILE:deburr> ARGUMENTS -v
  CLASSES Registers Blind)
