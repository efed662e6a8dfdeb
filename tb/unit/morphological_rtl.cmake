# SPDX-License-Identifier: MIT
# The morphological engine's hardware model: vectors of the contract, values by hand, clocks as
# documented.
set(TIMING_blocks LumaUnitBlock.*AClockLater EdgeDetectorBlock.TakesThreeClocks
    RunExtractorBlock.RecordIsThereAClockAfter RunExtractorBlock.AHorizontalRun.*WithoutAStall
    EndpointPredictorBlock.ARecordHolds EndpointPredictorBlock.EightIterations
    Divider.HasItsLatencyAndInterval)
set(TIMING_timing LatencyFormula Interlock Throughput BackPressure FramesBackToBack Stalls
    MemoryTime)
set(TIMING_store PixelStoreLanes PixelStoreBlock PixelStoreMemory)
set(TIMING_units AreaLanes.LatencyAndInterval AreaLanes.ARecordIsFinished WayOfARecord LineUnitBlock
    DividerPlaces PredictorUnits)
set(TIMING_bounds .*)
foreach(part vectors blocks timing engine reset store units registers ports bounds details)
  deburr_test(morphological_rtl_${part}_test LABELS unit TIMING ${TIMING_${part}}
              SOURCES morphological_rtl_${part}_test.cpp
              LINK deburr::rtl_morphological deburr::harness)
endforeach()
