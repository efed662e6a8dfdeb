# SPDX-License-Identifier: MIT
# libsquish as an oracle of BC decoding: optional. Debian's pkg-config file names a folder that does not exist.
find_library(DEBURR_SQUISH squish)
find_path(DEBURR_SQUISH_HEADER squish.h)
mark_as_advanced(DEBURR_SQUISH DEBURR_SQUISH_HEADER)
if(DEBURR_SQUISH AND DEBURR_SQUISH_HEADER)
  deburr_test(squish_test PROGRAM oracle_squish_tests LABELS oracle
    SOURCE "${CMAKE_CURRENT_LIST_DIR}/squish_test.cpp"
    LINK deburr::conformance "${DEBURR_SQUISH}")
else()
  add_test(NAME squish_test.absent COMMAND "${CMAKE_COMMAND}" -E echo
           "skipped: libsquish is absent (scripts/install oracle)")
  set_tests_properties(squish_test.absent PROPERTIES LABELS oracle SKIP_REGULAR_EXPRESSION "^skipped")
endif()
