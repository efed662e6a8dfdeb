// SPDX-License-Identifier: MIT
// Writes a picture of tb/stimuli to a file, for command runs on frames that load every unit.
//
//   write_frame random_edges 200 256 144 FILE   two tenths of all pixels on edges
//   write_frame diagonals 2 256 144 FILE        diagonals of two pixels
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tb/scene/image_io.h"
#include "tb/stimuli/frames.h"

int main(int argc, char** argv) {
  using namespace deburr::tb;
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    if (words.size() != 5) throw std::invalid_argument("PATTERN NUMBER WIDTH HEIGHT FILE");
    const int number = std::stoi(words[1]), width = std::stoi(words[2]),
              height = std::stoi(words[3]);
    if (words[0] == "random_edges")
      write_image(words[4], deburr::tb::stimuli::random_edges(width, height, number));
    else if (words[0] == "diagonals")
      write_image(words[4], deburr::tb::stimuli::diagonals(width, height, number));
    else
      throw std::invalid_argument("no pattern " + words[0]);
  } catch (const std::exception& error) {
    std::cerr << "write_frame: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
