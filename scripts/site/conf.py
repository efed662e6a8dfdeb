# SPDX-License-Identifier: MIT
"""Sphinx configuration for the pages that scripts/docs lays out."""
# pylint: disable=invalid-name
project = "Deburr"
html_title = "Deburr"
author = "The Deburr developers"
project_copyright = author
extensions = ["myst_parser"]
# Anchors as on GitHub, which the links of the pages use.
myst_heading_anchors = 6
html_theme = "furo"
# Debian builds the theme's style without its dark colours; these are the colours of the figures.
html_theme_options = {"top_of_page_button": None, "dark_css_variables": {
    "color-foreground-primary": "#e6edf3", "color-foreground-secondary": "#a5afba", "color-foreground-muted": "#8b95a1",
    "color-foreground-border": "#5b6570", "color-background-primary": "#14181f", "color-background-secondary": "#1b212a",
    "color-background-hover": "#232b36", "color-background-hover--transparent": "#232b3600",
    "color-background-border": "#3a444f", "color-background-item": "#3a444f", "color-brand-primary": "#58a6ff",
    "color-brand-content": "#58a6ff", "color-highlight-on-target": "#333300", "color-highlighted-background": "#083563",
    "color-problematic": "#ee5151"}}
html_static_path = ["_static"]
html_css_files = ["tables.css"]
html_show_sourcelink = False
html_copy_source = False
highlight_language = "none"
# Generated pages skip levels of headings.
suppress_warnings = ["myst.header"]
