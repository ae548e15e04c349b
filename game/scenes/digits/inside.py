"""Look inside: why a digit is not read as another, the sums that read it, and ten dreams of the same network."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from game.core import texts
from game.scenes.digits.dreams import DreamsTab
from game.scenes.digits.sums_tab import SumsTab
from game.scenes.digits.why_not import WhyNotTab
from game.ui.actions import digit_actions
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier
    from ai.digits.preprocessing import Image
    from game.core.scene import Transition
    from game.ui.actions import Table
    from game.ui.context import Context
    from game.ui.panel import Panel


class DigitInsideScene(PanelScene):
    """What a network makes of a digit (28, 28), on three tabs.

    Attributes:
        why_not, sums, dreams: the tabs.
        tab: the one that is shown.

    """

    def __init__(self, context: Context, classifier: DigitClassifier, image: Image) -> None:
        super().__init__(context)
        image = np.asarray(image, np.float32)
        self.why_not = WhyNotTab(classifier, image, self.build)
        self.sums = SumsTab(classifier, image, self.build)
        self.dreams = DreamsTab(classifier)
        self.tab: WhyNotTab | SumsTab | DreamsTab = self.why_not
        self.build()

    def actions(self) -> Table:
        digits = digit_actions(self.why_not.ask) if self.tab is self.why_not else ()
        return [self.form.goes_back(texts.HINT_BACK), *digits]

    def update(self) -> Transition | None:
        if not isinstance(self.tab, SumsTab):
            self.tab.update()
        return super().update()

    def describe(self, panel: Panel) -> None:
        tabs = self.why_not, self.sums, self.dreams
        words = [texts.WHY_NOT_TITLE.format(digit=self.why_not.asked), texts.SUMS_TITLE, texts.DREAMS_TITLE]
        panel.choice("", words, tabs.index(self.tab), lambda index: self.choose(tabs[index]))
        panel.gap()
        self.tab.describe(panel)

    def choose(self, tab: WhyNotTab | SumsTab | DreamsTab) -> None:
        """Show another tab."""
        self.tab = tab
        self.build()
