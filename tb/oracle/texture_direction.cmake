# SPDX-License-Identifier: MIT
# What the texture unit's rules are worth on a photograph, seen by a turned camera.
deburr_library(turned_photo LAYER tb
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/turned_photo.cpp"
  LINK deburr::golden_texture deburr::ideal deburr::scene deburr::texture_memory)
add_executable(scratch_direction "${CMAKE_CURRENT_LIST_DIR}/scratch.cpp")
target_link_libraries(scratch_direction PRIVATE deburr::turned_photo deburr_options)
