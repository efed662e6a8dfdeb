# SPDX-License-Identifier: MIT
"""What scripts/figures draws the pictures of the pages with."""
