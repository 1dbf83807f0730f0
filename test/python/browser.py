"""A headless Chromium that opens a page and keeps what goes wrong; skips where it is missing."""
from __future__ import annotations

import json
import os
import shutil
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Iterator, List

import pytest


class Browser:
    """An open page."""

    def __init__(self, driver: Any) -> None:
        self.driver = driver

    def run(self, script: str) -> Any:
        """Return what a script in the page returns."""
        return self.driver.execute_script(script)

    def wait(self, script: str) -> None:
        """Wait until a script returns something true."""
        from selenium.webdriver.support.ui import WebDriverWait
        WebDriverWait(self.driver, 30.0, 0.05).until(lambda driver: driver.execute_script(script))

    def errors(self) -> List[str]:
        """Return what stands on the console."""
        return [entry['message'] for entry in self.driver.get_log('browser')]

    def requests(self) -> List[str]:
        """Return the addresses that the page asked for; not those of data in itself."""
        events = [json.loads(entry['message'])['message']
                  for entry in self.driver.get_log('performance')]
        addresses = [event['params']['request']['url'] for event in events
                     if event['method'] == 'Network.requestWillBeSent']
        return [address for address in addresses if not address.startswith(('data:', 'blob:'))]


@contextmanager
def opened(page: Path, width: int = 1200, height: int = 900) -> Iterator[Browser]:
    """Open a page in a window of this size [pixels]."""
    webdriver = pytest.importorskip('selenium.webdriver', reason='python3-selenium is missing')
    import selenium
    if int(selenium.__version__.split('.')[0]) < 4:
        pytest.skip(f'selenium 4 is needed, this is {selenium.__version__}')
    programs = [shutil.which(name) for name in ('chromium', 'chromedriver')]
    if None in programs:
        pytest.skip('chromium or its driver is not installed')
    from selenium.webdriver.chrome.service import Service
    options = webdriver.ChromeOptions()
    options.binary_location = str(programs[0])
    for argument in ('--headless=new', '--disable-gpu', f'--window-size={width},{height}'):
        options.add_argument(argument)
    if os.geteuid() == 0:
        options.add_argument('--no-sandbox')  # it does not start as root otherwise
    options.set_capability('goog:loggingPrefs', {'browser': 'ALL', 'performance': 'ALL'})
    driver = webdriver.Chrome(service=Service(str(programs[1])), options=options)
    try:
        driver.execute_cdp_cmd('Emulation.setDeviceMetricsOverride', {
            'width': width, 'height': height, 'deviceScaleFactor': 1, 'mobile': width < 600})
        driver.get(page.as_uri())
        yield Browser(driver)
    finally:
        driver.quit()
