"""Settings of the documentation: `python -m sphinx .docs .docs/_build` writes its pages."""

import os
import sys
import warnings
from pathlib import Path

import matplotlib

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))
os.environ["MPLBACKEND"] = "module://matplotlib_inline.backend_inline"  # of the notebooks' kernels

matplotlib.use("Agg")  # of the pictures in the gallery

from generators import examples, methods, names, notebooks, plots, quantities, repository, scene_file  # noqa: E402

import linksweep  # noqa: E402

project = "linksweep"
author = "linksweep developers"
copyright = "linksweep developers"
release = version = linksweep.__version__

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "myst_nb",
]
exclude_patterns = [
    "_build",
    "jupyter_execute",
    "conf.py",
    "generators",
    "pictures",
    "templates",
    "generated/scene_keys.md",
]
templates_path = ["templates"]
default_role = "py:obj"  # `linksweep.sweep` is a link, any other word in backticks is code

autosummary_generate = True
autodoc_typehints = "none"  # docstrings state the types
toc_object_entries_show_parents = "hide"
numpydoc_xref_param_type = True
numpydoc_xref_aliases = names.classes()
numpydoc_xref_ignore = "all"
numpydoc_show_class_members = False  # the template lists them

myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 3
nb_custom_formats = {".py": ["jupytext.reads", {"fmt": "py:percent"}]}
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_merge_streams = True

PAGES_WITH_CONTENTS = (
    "index",
    "guide/*",
    "reference/*",
    "generated/gallery",
    "generated/methods",
    "generated/quantities",
    "generated/api/*",
)
"""Pages with a table of contents beside them; notebooks and benchmarks have the room for their lines and tables."""

html_static_path = ["static"]
html_css_files = ["style.css"]
html_theme = "pydata_sphinx_theme"
html_title = "linksweep"
html_context = {"default_mode": "auto"}
html_show_sphinx = html_show_copyright = html_show_sourcelink = False
html_theme_options = {
    "show_prev_next": True,
    "navigation_with_keys": False,
    "secondary_sidebar_items": {page: ["page-toc"] for page in PAGES_WITH_CONTENTS},
    "footer_start": [],
    "footer_end": [],
}


def write_pages(app):
    """Write the pages that are made of the package itself, before Sphinx looks for pages."""
    folder = HERE / "generated"
    for maker in (repository, examples, methods, plots, quantities, scene_file):
        maker.write(folder)


def setup(app):
    warnings.filterwarnings("ignore", category=DeprecationWarning)
    app.connect("config-inited", lambda app, config: write_pages(app))
    app.connect("source-read", repository.fit_links)
    app.connect("doctree-read", names.link_names)
    app.connect("autodoc-process-docstring", plots.complete, priority=400)  # before numpydoc
    app.connect("autodoc-skip-member", names.leave_out)
    app.connect("missing-reference", methods.link)
    app.connect("doctree-resolved", notebooks.check_outputs)
