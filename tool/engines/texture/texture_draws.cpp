// SPDX-License-Identifier: MIT
#include "tool/engines/texture/texture_draws.h"

namespace deburr::tool {

RandomDraws texture_draws() {
  RandomDraws all;
  all.draws = {{"sampler.lod_bias", evenly<-1600, 1600>},
               {"sampler.min_lod", evenly<0, 1600>},
               {"sampler.max_lod", evenly<0, 4000>},
               {"texture.cache.bytes", power_of_two<8, 16>},
               {"texture.cache.line_bytes", power_of_two<5, 7>},
               {"texture.cache.ways", power_of_two<0, 3>},
               {"texture.cache.fifo_depth", magnitude<2, 300>},
               {"texture.cache.compressed_lines", power_of_two<2, 6>},
               {"texture.axis_cycles", power_of_two<0, 2>}};
  all.frequent = {"texture.decode", "sampler.format"};
  // Fixed are a file, sequences, which only the golden model processes, and units in SystemVerilog,
  // which most builds lack.
  all.fixed = {"scene.fragments", "sequence.frames", "sequence.motion", "run.hdl"};
  return all;
}

}  // namespace deburr::tool
