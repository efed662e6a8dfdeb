# SPDX-License-Identifier: MIT
# The fabric and the harness, each block alone.
set(TIMING_link Link.BeatIsNotThere Link.FreedSlotIsNotFree Link.OnePushAndOnePop Link.Depth)
set(TIMING_parts Fifo.LatencyOne)
set(TIMING_memory MemoryPort.LatencyIsExact MemoryPort.OneRequestAClock
    MemoryPort.RateIsLimited MemoryPort.BandwidthOfTheMemory MemoryPort.BusyBanks)
set(TIMING_memory_shape Clocks/MemoryLatency.WordIsThereInTheClock
    Clocks/MemoryLatency.AStaleWord Clocks/MemoryLatency.OneAccessAClock Memory.AReadIssuedTooLate
    Memory.FlipFlopsAnswer)
foreach(part link clock parts memory memory_shape payload engine registers trace)
  deburr_test(fabric_${part}_test LABELS unit TIMING ${TIMING_${part}}
              SOURCES fabric_${part}_test.cpp LINK deburr::harness)
endforeach()
deburr_test(harness_test LABELS unit SOURCES harness_test.cpp LINK deburr::harness)
deburr_test(harness_negative_test LABELS negative SOURCES harness_negative_test.cpp
            LINK deburr::harness)
