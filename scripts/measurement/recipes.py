# SPDX-License-Identifier: MIT
"""Which pages are measured; importing this fills RECIPES."""
from measurement import morphological, results  # noqa: F401

# Pages whose every table is measured, or says that it is not.
MEASURED = ("results", "comparison", "geometric_quality", "morphological_quality",
            "filtering_conformance", "regression_report", "mutation", "coverage",
            "exploration/morphological_predictor", "exploration/search",
            "exploration/texture_cache", "exploration/texture_design", "exploration/texture_filter")
# Of these, what a program writes as a whole, and the test that says whether it is what it writes.
HELD = {"mutation": "mutation_record", "coverage": "app_pages"}
# Blocks that a program writes between its two marks, and the test that says the same of them.
GENERATORS = {"comparison_page": "comparison_page.all_is_current",
              "conformance_page": "conformance_page.is_current",
              "MorphologicalHarm.OfFramesByFormula": "deburr_test(harm_test",
              "MorphologicalHarm.OfFramesOfOthers": "deburr_test(harm_test"}
