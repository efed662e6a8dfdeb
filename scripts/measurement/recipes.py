# SPDX-License-Identifier: MIT
"""Which pages are measured; importing this fills RECIPES."""
from measurement import geometric, guides, morphological, results, synthesis  # noqa: F401

# Pages whose every table is measured, or says that it is not.
MEASURED = ("measurements/results", "measurements/comparison", "measurements/geometric_quality",
            "measurements/morphological_quality", "measurements/filtering_conformance", "reference/coverage",
            "measurements/tests", "measurements/morphological_harm", "measurements/geometric_morphological",
            "measurements/morphological_peers", "measurements/morphological_training")
# Of these, what a program writes as a whole, and the test that says whether it is what it writes.
HELD = {"reference/coverage": "app_pages"}
# Blocks that a program writes between its two marks, and the test that says the same of them.
GENERATORS = {"comparison_page": "comparison_page.all_is_current",
              "conformance_page": "conformance_page.is_current",
              "MorphologicalHarm.OfFramesByFormula": "deburr_test(harm_test",
              "MorphologicalHarm.OfFramesOfOthers": "deburr_test(harm_test",
              "MorphologicalHarm.OfTheTextGuard": "deburr_test(harm_test",
              "MorphologicalHarm.OfTheTextGuardOnWires": "deburr_test(harm_test",
              "MorphologicalHarm.OfTheTextGuardOnFramesOfOthers": "deburr_test(harm_test",
              "MorphologicalHarm.OfFramesWithTruth": "deburr_test(harm_test",
              "MorphologicalHarm.OfFramesOfOthersWithTruth": "deburr_test(harm_test"}
