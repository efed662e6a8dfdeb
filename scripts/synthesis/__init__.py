# SPDX-License-Identifier: MIT
"""Parts of scripts/synthesise: the list of units (designs), their mapping (flows), the page (page)."""
