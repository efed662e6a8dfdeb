# SPDX-License-Identifier: MIT
deburr_script_test(papers LABELS system long ARGUMENTS $<TARGET_FILE:deburr>)
