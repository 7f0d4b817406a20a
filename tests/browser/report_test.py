#!/usr/bin/env python3
"""Opens report.html in a real browser and holds it to what the folder says.

    report_test.py PROGRAM

Simulates a drive and reconstructs it into a temporary folder. Ends
with 77, the status of a skipped test, where the browser or its driver is
missing.
"""

import csv
import json
import random
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SKIPPED = 77
try:
    from selenium import webdriver
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.support.ui import WebDriverWait
except ImportError:
    print('skipped: python3-selenium is not installed (./setup.sh tests)')
    sys.exit(SKIPPED)

DRIVER = Path('/usr/bin/chromedriver')
BROWSER = Path('/usr/bin/chromium')
HOSTILE = '</script><b>'


def open_browser(width=1280, height=900, dark=False, script=True):
    options = Options()
    options.binary_location = str(BROWSER)
    for flag in ('--headless=new', '--no-sandbox', '--disable-gpu',
                 '--disable-dev-shm-usage', f'--window-size={width},{height}'):
        options.add_argument(flag)
    if dark:
        options.add_argument('--force-dark-mode')
    if not script:
        options.add_experimental_option(
            'prefs', {'profile.managed_default_content_settings.javascript': 2})
    options.set_capability('goog:loggingPrefs',
                           {'browser': 'ALL', 'performance': 'ALL'})
    return webdriver.Chrome(service=Service(str(DRIVER)), options=options)


def rows_of(path):
    with open(path, encoding='utf-8') as file:
        return list(csv.DictReader(line for line in file if line[0] != '#'))


class Page:
    """A page in a browser of its own."""

    def __init__(self, path, **options):
        self.browser = open_browser(**options)
        self.browser.set_page_load_timeout(30)
        if 'width' in options:
            self.resize(options['width'], options.get('height', 900))
        if options.get('dark'):
            self.browser.execute_cdp_cmd(
                'Emulation.setEmulatedMedia',
                {'features': [{'name': 'prefers-color-scheme',
                               'value': 'dark'}]})
        self.browser.get(Path(path).as_uri())

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        self.browser.quit()

    def resize(self, width, height):
        self.browser.execute_cdp_cmd(
            'Emulation.setDeviceMetricsOverride',
            {'width': width, 'height': height, 'deviceScaleFactor': 1,
             'mobile': width < 600})

    def js(self, script, *arguments):
        return self.browser.execute_script('return ' + script, *arguments)

    def load_rows(self):
        self.browser.execute_script('view.load()')
        WebDriverWait(self.browser, 20).until(
            lambda _: self.js('document.documentElement.dataset.loaded'))

    def errors(self):
        return [entry for entry in self.browser.get_log('browser')
                if entry['level'] == 'SEVERE']

    def requests(self):
        urls = []
        for entry in self.browser.get_log('performance'):
            message = json.loads(entry['message'])['message']
            if message['method'] == 'Network.requestWillBeSent':
                urls.append(message['params']['request']['url'])
        return [url for url in urls if not url.startswith('data:')]


class ReportTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix='hindsight-report-'))
        program = sys.argv[1]
        recording = cls.folder / 'recording'
        subprocess.run([program, 'simulate', 'short_drive', '--seed=1',
                        f'--out={recording}'], check=True,
                       stdout=subprocess.DEVNULL)
        cls.out = cls.folder / 'out'
        subprocess.run([program, 'run', str(recording / 'config.yaml'),
                        '--methods=ekf,two_filter,imm,batch',
                        '--withhold=gnss:every=60s,length=15s',
                        f'--out={cls.out}', '--report'], check=False,
                       stdout=subprocess.DEVNULL)
        cls.path = cls.out / 'report.html'
        cls.page = Page(cls.path, width=1280)

    @classmethod
    def tearDownClass(cls):
        cls.page.__exit__()
        subprocess.run(['rm', '-rf', str(cls.folder)], check=True)

    def setUp(self):
        self.page.browser.execute_script('view.all(); view.setCursor(null)')

    def test_a_no_error_and_no_request_but_the_file(self):
        self.assertEqual(self.page.js('document.documentElement.dataset.ready'),
                         'yes')
        self.assertEqual(self.page.errors(), [])
        self.assertEqual(self.page.requests(), [self.path.as_uri()])

    def test_every_panel_has_content(self):
        panels = self.page.js(
            "[...document.querySelectorAll('section')].map(s => [s.id,"
            " s.querySelectorAll('table, figure, .absent, pre').length,"
            " s.querySelectorAll('.plot canvas, #map-view canvas').length])")
        self.assertEqual(len(panels), 16)
        for name, things, _ in panels:
            self.assertGreater(things, 0, name)
        drawn = {name for name, _, canvases in panels if canvases > 0}
        self.assertLessEqual({'timeline', 'map', 'accuracy', 'separation',
                              'residuals', 'receiver', 'biases', 'motion',
                              'differences', 'truth', 'modes'}, drawn)

    def test_something_is_drawn_in_every_chart(self):
        empty = self.page.js(
            "charts.filter(c => { const k = c.plot.querySelectorAll('canvas');"
            " return ![...k].some(e => new Uint32Array(e.getContext('2d')"
            ".getImageData(0, 0, e.width, e.height).data.buffer)"
            ".some(x => x !== 0)); }).map(c => c.spec.title)")
        self.assertEqual(empty, [])

    def test_zoom_and_cursor_move_together(self):
        self.page.browser.execute_script(
            'view.setWindow(40, 80); view.setCursor(50)')
        self.page.browser.execute_script(
            'for (const one of all) { one.onScreen = true; }'
            'view.setWindow(40, 80); view.setCursor(50)')
        windows = self.page.js(
            'charts.map(c => c.graph.xAxisRange())')
        for low, high in windows:
            self.assertAlmostEqual(low, 40, places=6)
            self.assertAlmostEqual(high, 80, places=6)
        places = self.page.js(
            'charts.map(c => c.graph.toDataXCoord(parseFloat('
            "c.cursorLine.style.transform.slice(11))))")
        for t in places:
            self.assertAlmostEqual(t, 50, places=3)
        self.assertAlmostEqual(
            self.page.js('timeLine.timeAt(timeLine.xOf(50))'), 50, places=6)

    def test_dragging_over_a_chart_zooms_and_a_double_click_shows_all(self):
        chart = self.page.browser.find_element(By.CSS_SELECTOR,
                                               '#accuracy .plot')
        self.page.browser.execute_script(
            "arguments[0].scrollIntoView({block: 'center'})", chart)
        actions = webdriver.ActionChains(self.page.browser)
        actions.move_to_element_with_offset(chart, -50, 0).click_and_hold()
        actions.move_by_offset(100, 0).release().perform()
        low, high = self.page.js('view.window')
        begin, end = self.page.js('view.extent')
        self.assertGreater(low, begin)
        self.assertLess(high, end)
        webdriver.ActionChains(self.page.browser).double_click(chart).perform()
        self.assertEqual(self.page.js('view.window'), [begin, end])

    def test_values_equal_the_files_to_the_quantum(self):
        self.page.load_rows()
        random.seed(1)
        titles = {'height': 'h[m]', 'v_d': 'v_d[m/s]',
                  'bg_x': 'bg_x[deg/h]', 'roll': 'roll[deg]',
                  'heading': 'heading[deg]', 'sd_n': 'sd_n[m]',
                  'v_e': 'v_e[m/s]', 'bg_z': 'bg_z[deg/h]'}
        groups = self.page.js('page.groups')
        for group in groups:
            rows = rows_of(self.out / (group['label'] + '.csv'))
            table = group['table']
            self.assertEqual(self.page.js(f'page.tables[{table}].t.length'),
                             len(rows))
            chosen = random.sample(range(len(rows)), 25)
            times = self.page.js(
                f'arguments[0].map(k => page.tables[{table}].t[k])', chosen)
            for k, t in zip(chosen, times):
                self.assertAlmostEqual(t, float(rows[k]['t[s]']), delta=1e-6)
            for name, title in titles.items():
                if not self.page.js(f'page.tables[{table}].has("{name}")'):
                    self.assertNotEqual(group['label'], 'batch')
                    continue
                values, quantum = self.page.js(
                    '[arguments[0].map(k =>'
                    f' page.tables[{table}].column("{name}")[k]),'
                    f' page.tables[{table}].json.columns["{name}"].quantum]',
                    chosen)
                for k, value in zip(chosen, values):
                    self.assertAlmostEqual(value, float(rows[k][title]),
                                           delta=0.5001 * quantum + 1e-12)

    def test_values_at_the_cursor_are_those_of_the_file(self):
        self.page.load_rows()
        rows = rows_of(self.out / 'batch.csv')
        self.page.browser.execute_script(
            'for (const one of all) { one.onScreen = true; }'
            f"view.setCursor({rows[70]['t[s]']})")
        shown = self.page.js(
            "charts.find(c => c.spec.title.startsWith('Height above')).values"
            ".find(v => v.line.label === 'batch').value.textContent")
        self.assertAlmostEqual(float(shown), float(rows[70]['h[m]']), delta=0.06)

    def test_differences_are_those_of_the_files(self):
        self.page.load_rows()
        rows = {name: {row['t[s]']: row for row in
                       rows_of(self.out / (name + '.csv'))}
                for name in ('ekf', 'batch')}
        t, v = self.page.js(
            "(() => { const c = charts.find(c => c.spec.difference &&"
            " c.spec.title === 'Height'); const s = c.lines.find(l => !l.bound"
            " && l.label === 'ekf').series();"
            " return [[...s.t], [...s.v].map(x => isNaN(x) ? null : x)]; })()")
        by_time = {float(time): time for time in rows['ekf']}
        checked = 0
        for time, value in zip(t, v):
            key = min(by_time, key=lambda x: abs(x - time))
            if value is None or by_time[key] not in rows['batch']:
                continue
            wanted = (float(rows['ekf'][by_time[key]]['h[m]']) -
                      float(rows['batch'][by_time[key]]['h[m]']))
            self.assertAlmostEqual(value, wanted, delta=0.0011)
            checked += 1
        self.assertGreater(checked, 50)

    def column_of_chart(self, section, title, label):
        """Times and values of a line, None where there is none."""
        return self.page.js(
            "(() => { const c = charts.find(c => c.element.closest('section')"
            ".id === arguments[0] && c.spec.title === arguments[1]);"
            " const l = c.lines.find(l => l.label === arguments[2]);"
            " const s = l.series();"
            " const table = page.tables[l.table];"
            " return [[...s.t], [...s.v].map(x => isNaN(x) ? null : x),"
            " table.json.columns[l.column].quantum]; })()",
            section, title, label)

    def expect_equal(self, shown, rows, title):
        times, values, quantum = shown
        self.assertEqual(len(times), len(rows))
        random.seed(2)
        known = 0
        for k in random.sample(range(len(rows)), 40):
            self.assertAlmostEqual(times[k], float(rows[k]['t[s]']), delta=2e-6)
            if rows[k][title] == '':
                self.assertIsNone(values[k])
                continue
            known += 1
            self.assertAlmostEqual(values[k], float(rows[k][title]),
                                   delta=0.5001 * quantum + 1e-12)
        self.assertGreater(known, 20)

    def test_separation_is_that_of_the_file_with_its_envelope(self):
        self.page.load_rows()
        rows = rows_of(self.out / 'two_filter.csv')
        for title, name in (('North', 'n[m]'), ('Velocity east', 'v_e[m/s]'),
                            ('Heading', 'heading[deg]')):
            self.expect_equal(self.column_of_chart(
                'separation', title, 'forward minus backward'), rows,
                'separation_' + name)
            times, bound, _ = self.column_of_chart('separation', title,
                                                   '3 sigma')
            for k in range(0, len(rows), 17):
                sigma = rows[k]['sd_separation_' + name]
                if sigma == '':
                    self.assertIsNone(bound[k])
                else:
                    self.assertAlmostEqual(bound[k], 3 * float(sigma),
                                           delta=0.01 * 3 * float(sigma))

    def test_body_motion_is_that_of_the_file(self):
        self.page.load_rows()
        rows = rows_of(self.out / 'batch.motion.csv')
        self.expect_equal(self.column_of_chart('motion', 'Body rate', 'down'),
                          rows, 'w_z[deg/s]')
        self.expect_equal(self.column_of_chart('motion', 'Specific force',
                                               'forward'), rows, 'f_x[m/s^2]')

    def test_the_receiver_shows_quality_and_satellites(self):
        folder = self.folder / 'receiver'
        subprocess.run(['cp', '-r', str(self.out), str(folder)], check=True)
        path = folder / 'fixes.csv'
        lines = path.read_text().splitlines()
        at = next(i for i, line in enumerate(lines) if line[0] == 't')
        for i in range(at + 1, len(lines)):
            fields = lines[i].split(',')
            fields[8:10] = [str(4 if i % 5 == 0 else 1), str(8 + i % 3)]
            lines[i] = ','.join(fields)
        path.write_text('\n'.join(lines) + '\n')
        summary = json.loads((folder / 'summary.json').read_text())
        summary['fixes']['gnss']['quality_percent'] = {'1': 80, '4': 20}
        (folder / 'summary.json').write_text(json.dumps(summary))
        subprocess.run([sys.argv[1], 'report', str(folder)], check=True,
                       stdout=subprocess.DEVNULL)
        with Page(folder / 'report.html', width=1280) as page:
            page.load_rows()
            self.assertEqual(page.errors(), [])
            titles = page.js("charts.filter(c => c.element.closest('section')"
                             ".id === 'receiver').map(c => c.spec.title)")
            self.assertEqual(titles, ['gnss: quality', 'gnss: satellites',
                                      'gnss: stated sigma'])
            self.assertEqual(page.js(
                "[...new Set([...charts.find(c => c.spec.title ==="
                " 'gnss: quality').lines[0].series().v])].sort()"), [1, 4])
            self.assertIn('80.0', page.js(
                "document.querySelector('#receiver table').textContent"))

    def test_the_map_is_coloured_by_every_quantity(self):
        pictures = set()
        for mode in self.page.js('map.modes.map(m => m[1])'):
            self.page.browser.execute_script(
                "const s = document.querySelector('#map-tools select');"
                "s.selectedIndex = map.modes.findIndex("
                "m => m[1] === arguments[0]);"
                "s.dispatchEvent(new Event('change'))", mode)
            pictures.add(self.page.js('map.canvas.toDataURL()'))
        self.assertEqual(len(pictures), 4)

    def test_the_map_colours_a_span_by_its_grade(self):
        self.page.browser.execute_script(
            'page.map.grades = [{from: 20, to: 30, grade: 1},'
            ' {from: 25, to: 26, grade: 2}]')
        self.assertEqual(self.page.js('[10, 22, 25.5, 28, 31].map(gradeAt)'),
                         [0, 1, 2, 1, 0])

    def test_inputs_are_listed_with_their_checksums(self):
        summary = json.loads((self.out / 'summary.json').read_text())
        text = self.page.js("document.querySelector('#config').textContent")
        self.assertGreaterEqual(len(summary['inputs']), 3)
        for one in summary['inputs']:
            self.assertIn(one['sha256'], text)
            self.assertEqual(len(one['sha256']), 64)

    def test_evaluate_makes_the_same_page(self):
        path = self.folder / 'evaluated.html'
        subprocess.run([sys.argv[1], 'evaluate', str(self.out / 'batch.csv'),
                        str(self.folder / 'recording' / 'truth.csv'),
                        f'--out={path}'], check=True,
                       stdout=subprocess.DEVNULL)
        with Page(path, width=1280) as page:
            self.assertEqual(page.errors(), [])
            self.assertEqual(page.js('page.groups.map(g => g.label)'),
                             ['batch'])
            self.assertGreater(page.js(
                "document.querySelectorAll('#truth .plot canvas').length"), 0)

    def test_keys_zoom_and_move_the_cursor(self):
        body = self.page.browser.find_element(By.TAG_NAME, 'body')
        length = self.page.js('view.window[1] - view.window[0]')
        body.send_keys('+')
        self.assertAlmostEqual(self.page.js('view.window[1] - view.window[0]'),
                               length / 2, places=6)
        body.send_keys(Keys.ARROW_RIGHT)
        first = self.page.js('view.cursor')
        body.send_keys(Keys.ARROW_RIGHT)
        self.assertGreater(self.page.js('view.cursor'), first)
        body.send_keys('0')
        self.assertAlmostEqual(self.page.js('view.window[1] - view.window[0]'),
                               length, places=6)

    def test_a_method_is_switched_off_everywhere(self):
        button = self.page.browser.find_elements(By.CSS_SELECTOR,
                                                 'button.solution')[1]
        button.click()
        visible = self.page.js(
            "charts.filter(c => c.lines.some(l => l.group === 1))"
            ".map(c => c.lines.every(l => l.group !== 1 || !c.shows(l)))")
        self.assertTrue(all(visible))
        button.click()
        self.assertTrue(self.page.js('view.shows(1)'))

    def test_an_outage_zooms_everything(self):
        row = self.page.browser.find_element(By.CSS_SELECTOR,
                                             '#outages tr.zooms')
        self.page.browser.execute_script('arguments[0].click()', row)
        low, high = self.page.js('view.window')
        self.assertAlmostEqual(high - low, 25, delta=1)

    def test_every_width_holds_all_charts_without_sideways_scroll(self):
        with Page(self.path, width=360, height=800) as page:
            for width in (360, 1280, 2560):
                if width > 360:
                    page.resize(width, 1000)
                    page.browser.refresh()
                self.assertEqual(page.errors(), [])
                self.assertLessEqual(
                    page.js('document.documentElement.scrollWidth'), width)
                narrow = page.js(
                    "charts.filter(c => c.plot.clientWidth < 250 ||"
                    " c.plot.getBoundingClientRect().right >"
                    " window.innerWidth + 1).map(c => c.spec.title)")
                self.assertEqual(narrow, [], width)

    def test_dark_mode_has_a_dark_ground(self):
        with Page(self.path, width=1280, dark=True) as page:
            self.assertEqual(
                page.js("getComputedStyle(document.body).backgroundColor"),
                'rgb(20, 24, 30)')
            self.assertEqual(page.errors(), [])

    def test_prints_to_several_pages(self):
        pdf = self.page.browser.execute_cdp_cmd('Page.printToPDF', {})
        self.assertGreater(len(pdf['data']), 100000)
        self.assertEqual(self.page.errors(), [])

    def test_tables_stand_without_script(self):
        with Page(self.path, width=1280, script=False) as page:
            text = page.browser.page_source
            self.assertIn('The charts need JavaScript', text)
            tables = page.browser.find_elements(By.CSS_SELECTOR, 'table')
            self.assertGreater(len(tables), 20)

    def test_hostile_names_are_text(self):
        other = self.folder / 'hostile'
        subprocess.run(['cp', '-r', str(self.out), str(other)], check=True)
        for name in ('residuals.csv', 'fixes.csv', 'summary.json',
                     'config.resolved.yaml'):
            path = other / name
            path.write_text(path.read_text().replace('gnss,', HOSTILE + ',')
                            .replace('"gnss"', json.dumps(HOSTILE))
                            .replace('short_drive', HOSTILE))
        subprocess.run([sys.argv[1], 'report', str(other)], check=True,
                       stdout=subprocess.DEVNULL)
        with Page(other / 'report.html', width=1280) as page:
            self.assertEqual(page.errors(), [])
            self.assertEqual(page.js("document.querySelectorAll('b').length"),
                             page.js("document.querySelectorAll('figcaption b,"
                                     " .verdict b').length"))
            self.assertIn(HOSTILE, page.js(
                "document.querySelector('#timeline table').textContent"))
            self.assertEqual(page.js("document.querySelector('h1')"
                                     ".textContent"), HOSTILE)


if __name__ == '__main__':
    if not (DRIVER.exists() and BROWSER.exists()):
        print('skipped: chromium or chromium-driver is not installed '
              '(./setup.sh tests)')
        sys.exit(SKIPPED)
    unittest.main(argv=sys.argv[:1], verbosity=2)
