# SPDX-License-Identifier: MIT
# Blocks of the texture unit's hardware model: values by hand from the contract, clocks as documented.
set(TIMING_address TextureRtlDerivative.OneClockACoveredLane TextureRtlFootprint.Latency
    TextureRtlLog2.Latency TextureRtlWalker.CostsNTimesLevels TextureRtlAddresser.Latency
    TextureRtlAddressUnit.Latency)
set(TIMING_cache TextureRtlCache.TimesByTable TextureRtlCache.HitIsNotReadyAClockEarlier
    TextureRtlCache.MissQueueAccounts TextureRtlCache.FullQueueStalls
    TextureRtlCache.HitsGoOn TextureRtlCache.FullFifoStalls TextureRtlCache.LatencyIsHidden
    TextureRtlCache.BankPasses)
set(TIMING_filter TextureRtlFilter.LatencyIsSeven TextureRtlFilter.OneRequestAClock)
set(TIMING_unit TextureRtlUnit.Latency TextureRtlUnit.WarmCache TextureRtlUnit.FragmentCosts
    TextureRtlUnit.StallDelays)
foreach(part address cache filter unit)
  deburr_test(texture_rtl_${part}_test LABELS unit TIMING ${TIMING_${part}}
              SOURCES texture_rtl_${part}_test.cpp LINK deburr::rtl_texture deburr::harness)
endforeach()
