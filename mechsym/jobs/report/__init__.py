"""The report of one case or of several side by side: one HTML file that opens offline.

part.py    one part, also one that failed           parts.py   the parts, each by the job of its command
build.py   case -> parts, and the page              answer.py  its first page
"""

from mechsym.jobs.report.build import CaseReport, case_report, html

__all__ = ["CaseReport", "case_report", "html"]


def __dir__() -> list[str]:
    return __all__
