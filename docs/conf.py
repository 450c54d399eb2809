"""The manual's configuration: ``sphinx-build -W --keep-going docs target/docs`` from the root."""

import sys
from pathlib import Path

from crankpin import __version__, results

sys.path.insert(0, str(Path(__file__).parent))

project = "crankpin"
version = release = __version__
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "manual"]
exclude_patterns = ["**/.ipynb_checkpoints"]

html_theme = "furo"
html_title = "crankpin"
html_static_path = ["_static"]
html_css_files = ["manual.css"]
html_js_files = ["wall.js"]
html_search_scorer = str(Path(__file__).with_name("_search.js"))
html_copy_source = False
html_show_copyright = False
html_show_search_summary = False  # browsers do not let pages of files read others

myst_heading_anchors = 4
myst_enable_extensions = ["dollarmath"]
nb_execution_mode = "off"  # the tutorials keep their outputs
nb_render_markdown_format = "myst"
html_math_renderer = "mathml"  # of the extension "manual": needs no script from elsewhere

autodoc_default_options = {"members": True, "inherited-members": "object, Exception, dict"}
autodoc_member_order = "groupwise"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented_params"
autodoc_preserve_defaults = True
napoleon_numpy_docstring = True
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False
napoleon_preprocess_types = True
napoleon_type_aliases = {name: f"crankpin.results.{name}" for name in results.__all__}

nitpicky = True
# Names of other packages, and types in annotations that are not public.
nitpick_ignore_regex = [
    ("py:.*", r"(?!crankpin\.).*"),
    ("py:class", r"crankpin\.(_|model|analysis).*"),
]
