# SPDX-License-Identifier: MIT
deburr_test(scene_test LABELS unit
  SOURCES scene_image.cpp scene_textures.cpp scene_mesh.cpp scene_raster.cpp scene_truth.cpp
  LINK deburr::scene deburr_openimageio)
target_compile_definitions(scene_test PRIVATE DEBURR_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
