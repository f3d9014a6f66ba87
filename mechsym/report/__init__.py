"""The report of one case or of several side by side: one HTML file that opens offline.

parts.py   the parts, each by the job of its command, and the first page: `PARTS` has a row for each
part.py    one of them
build.py   case -> parts, and the page                  numbers.py  the same as JSON
"""

from mechsym.report.build import CaseReport, case_report, html

__all__ = ["CaseReport", "case_report", "html"]


def __dir__() -> list[str]:
    return __all__
