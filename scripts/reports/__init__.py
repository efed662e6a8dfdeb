# SPDX-License-Identifier: MIT
"""Tables of scripts/report."""
