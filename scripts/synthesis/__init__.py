# SPDX-License-Identifier: MIT
"""What scripts/synthesise does: which units there are (designs), how they are mapped (flows), the page (page)."""
