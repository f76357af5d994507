"""The papers and standards that the figures of a report come from."""

from __future__ import annotations

from collections.abc import Iterator

from equipoise.i18n import say, to_say
from equipoise.present.findings import Findings, ToolFindings

KIM_CHUNG = (
    "Kim, K. U., Chung, C. J.: An analytical method for kinematic analysis of the planting "
    "mechanism of a rice transplanter, c. 1977"
)
YAMASHITA = (
    "山下光司, 市川真祐, 森邦男: 田植機における植付爪の振動消去に関する研究 "
    "(Yamashita, Ichikawa, Mori: Studies on control of vibrations originating in rice "
    "transplanting mechanism), c. 1982"
)
LEE_KIM = (
    "李政基, 金景旭: 크랭크식 移秧機 植付機構의 動的 均衡에 관한 研究 "
    "(Lee, Kim: Dynamic balancing of crank-type transplanting mechanism of rice "
    "transplanter), c. 1990"
)
NAGAMINE_IRIE = (
    "長嶺正紀, 入江敏博: 刈払機の振動特性について "
    "(Nagamine, Irie: On the vibration characteristics of a brush cutter), 1970"
)
ISO_5349 = "ISO 5349-1:2001, ISO 5349-2:2001"
DIRECTIVE = "Directive 2002/44/EC"
ISO_22867 = "ISO 22867"

USED = {
    "force": to_say("Shaking force, drive torque, balancing, vibration on a support: {source}"),
    "moment": to_say("Shaking moment, shaking energy, geared counterweights: {source}"),
    "planting": to_say("Figures of planting: {source}"),
    "shaft": to_say("Vibration of the shaft and transmission to the hands: {source}"),
    "hands": to_say("Weighting and daily exposure of the hands: {source}"),
}


def sources(findings: Findings | ToolFindings) -> Iterator[str]:
    """What was used, a line each."""
    if isinstance(findings, ToolFindings):
        yield say(USED["shaft"], source=NAGAMINE_IRIE)
        if findings.exposure is not None:
            yield say(USED["hands"], source=f"{ISO_5349}; {DIRECTIVE}; {ISO_22867}")
        return
    if findings.analysis.solved is not None:
        yield say(USED["force"], source=YAMASHITA)
        yield say(USED["moment"], source=LEE_KIM)
    if findings.planting is not None:
        yield say(USED["planting"], source=KIM_CHUNG)
