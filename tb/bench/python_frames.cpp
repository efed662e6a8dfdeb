// SPDX-License-Identifier: MIT
// The C++ side of tb/bench/python_golden.py: smooths a frame TIMES times with one golden model.
//
// usage: python_frames FILE WIDTH HEIGHT PRESET TIMES; FILE holds R, G, B, A of each pixel
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <vector>

#include "golden/morphological/morphological_golden.h"

int main(int argc, char** argv) {
  using deburr::golden::morphological::MorphologicalGolden;
  using deburr::spec::morphological::kPresetNames;
  using deburr::spec::morphological::Preset;
  if (argc != 6) return 2;
  const int width = std::atoi(argv[2]), height = std::atoi(argv[3]), times = std::atoi(argv[5]);
  std::size_t preset = 0;
  while (preset < kPresetNames.size() && kPresetNames[preset] != argv[4]) ++preset;
  std::vector<deburr::spec::morphological::Rgba8> pixels(static_cast<std::size_t>(width) *
                                                         static_cast<std::size_t>(height));
  std::ifstream file(argv[1], std::ios::binary);
  file.read(reinterpret_cast<char*>(pixels.data()),
            static_cast<std::streamsize>(4 * pixels.size()));
  if (!file || preset == kPresetNames.size()) return 2;
  MorphologicalGolden golden(
      deburr::spec::morphological::preset_parameters(static_cast<Preset>(preset)),
      MorphologicalGolden::Detail::kPixels);
  for (int i = 0; i < times; ++i) golden.process({pixels, width, height});
  std::printf("%llu\n", static_cast<unsigned long long>(golden.work().blended_pixels));
  return 0;
}
